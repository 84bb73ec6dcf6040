"""Sending the arm somewhere and waiting until it has come to rest."""

from collections.abc import Callable

from tapreach.control.motion import Progress, Senses
from tapreach.errors import LinkLost
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import STILL, ArmPose, Twist

SETTLE_NS = 150 * MS
GIVE_UP_NS = 10 * SECOND


class ArmMove:
    """Ends when the arm has reported rest for 150 ms; gives up after 10 s. The wheels stand meanwhile.

    `send` passes the target on to the arm, once, at the first step.
    """

    moves_arm = True

    def __init__(self, send: Callable[[ArmPose], object], target: ArmPose) -> None:
        self.progress = Progress.MOVING
        self.reason = ""
        self._send = send
        self._target = target
        self._start_ns: int | None = None
        self._resting_since_ns: int | None = None

    def step(self, senses: Senses, now_ns: int) -> Twist:
        """See Motion."""
        if self._start_ns is None:
            self._start_ns = now_ns
            self._begin()
        if self.progress is Progress.MOVING:
            self._watch(senses, now_ns, self._start_ns)
        return STILL

    def _begin(self) -> None:
        try:
            self._send(self._target)
        except LinkLost as error:
            self.progress, self.reason = Progress.GIVEN_UP, str(error)

    def _watch(self, senses: Senses, now_ns: int, start_ns: int) -> None:
        arm = senses.arm
        if arm is None or arm.is_moving or arm.captured_ns <= start_ns:
            self._resting_since_ns = None
        elif self._resting_since_ns is None:
            self._resting_since_ns = now_ns
        elif now_ns - self._resting_since_ns >= SETTLE_NS:
            self.progress = Progress.ARRIVED
            return
        if now_ns - start_ns >= GIVE_UP_NS:
            self.progress, self.reason = Progress.GIVEN_UP, "the arm did not come to rest within 10 s"
