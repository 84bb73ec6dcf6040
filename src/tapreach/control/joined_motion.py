"""Motions made of others: one after the other, the arm before the wheels; and coming to rest."""

from collections.abc import Sequence

from tapreach.control.arm_move import ArmMove
from tapreach.control.motion import Motion, Progress, Senses
from tapreach.robot.clock import MS
from tapreach.robot.messages import STILL, Twist

REST_LINEAR, REST_ANGULAR = 0.004, 0.02
"""Speeds [m/s], [rad/s] below which odometry calls it rest."""
REST_WITHIN_NS = 400 * MS


class Rest:
    """Stand still until odometry says so, or for 0.4 s at most."""

    moves_arm = False
    reason = ""

    def __init__(self) -> None:
        self.progress = Progress.MOVING
        self._start_ns: int | None = None

    def step(self, senses: Senses, now_ns: int) -> Twist:
        """See Motion."""
        self._start_ns = self._start_ns or now_ns
        reading = senses.odometry
        if reading is not None and reading.captured_ns >= self._start_ns:
            twist = reading.twist
            if abs(twist.linear) <= REST_LINEAR and abs(twist.angular) <= REST_ANGULAR:
                self.progress = Progress.ARRIVED
        if now_ns - self._start_ns >= REST_WITHIN_NS:
            self.progress = Progress.ARRIVED
        return STILL


class InTurn:
    """One motion after the other, without a pause; ends with the first that is given up."""

    moves_arm = False

    def __init__(self, motions: Sequence[Motion]) -> None:
        self._motions = list(motions)

    @property
    def progress(self) -> Progress:
        """See Motion."""
        return self._motions[0].progress

    @property
    def reason(self) -> str:
        """See Motion."""
        return self._motions[0].reason

    def step(self, senses: Senses, now_ns: int) -> Twist | None:
        """See Motion."""
        twist = self._motions[0].step(senses, now_ns)
        while self._motions[0].progress is Progress.ARRIVED and len(self._motions) > 1:
            self._motions.pop(0)
            twist = self._motions[0].step(senses, now_ns)
        return twist


class ArmFirst:
    """The wheels, as soon as the arm has come to rest: on its way it may pass before the camera."""

    moves_arm = True

    def __init__(self, wheels: Motion, arm: ArmMove) -> None:
        self._wheels, self._arm = wheels, arm

    @property
    def progress(self) -> Progress:
        """See Motion."""
        both = {self._wheels.progress, self._arm.progress}
        if Progress.GIVEN_UP in both:
            return Progress.GIVEN_UP
        return Progress.MOVING if Progress.MOVING in both else Progress.ARRIVED

    @property
    def reason(self) -> str:
        """See Motion."""
        return self._wheels.reason or self._arm.reason

    def step(self, senses: Senses, now_ns: int) -> Twist | None:
        """See Motion."""
        if self._arm.progress is Progress.MOVING:
            return self._arm.step(senses, now_ns)
        return self._wheels.step(senses, now_ns)
