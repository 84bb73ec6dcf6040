"""Leading the arm through poses, each at its time, so that the claw keeps to a line and to a speed."""

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tapreach.control.arm_move import ArmMove
from tapreach.control.motion import Progress, Senses
from tapreach.errors import InputError, LinkLost
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import STILL, ArmPose, Twist


@dataclass(frozen=True, slots=True)
class TimedPose:
    """A pose of the arm, and when it is to be there [s] after the start."""

    time: float
    pose: ArmPose


class ArmPathMotion:
    """Sends the pose of each moment, straight between neighbours in the joints; the wheels stand meanwhile.

    Servos that are led in small steps stay together, where one far target would let each run at its own
    full speed. After the last pose it waits for rest as ArmMove does. Raises InputError for a path without
    poses or with times that do not rise.
    """

    moves_arm = True

    def __init__(self, send: Callable[[ArmPose], object], path: Sequence[TimedPose]) -> None:
        self._times = [timed.time for timed in path]
        if not path or any(
            later <= earlier for earlier, later in zip(self._times, self._times[1:], strict=False)
        ):
            raise InputError(f"the times of an arm's path must rise; they are {self._times}")
        self._send = send
        self._poses = [timed.pose for timed in path]
        self._landing = ArmMove(send, self._poses[-1])
        self._start_ns: int | None = None
        self._failure = ""

    @property
    def progress(self) -> Progress:
        """See Motion."""
        return Progress.GIVEN_UP if self._failure else self._landing.progress

    @property
    def reason(self) -> str:
        """See Motion."""
        return self._failure or self._landing.reason

    def step(self, senses: Senses, now_ns: int) -> Twist:
        """See Motion."""
        self._start_ns = now_ns if self._start_ns is None else self._start_ns
        elapsed = (now_ns - self._start_ns) / SECOND
        if elapsed >= self._times[-1]:
            return self._landing.step(senses, now_ns)
        try:
            self._send(self._at(elapsed))
        except LinkLost as error:
            self._failure = str(error)
        return STILL

    def _at(self, elapsed: float) -> ArmPose:
        after = bisect_right(self._times, elapsed)
        if after == 0:
            return self._poses[0]
        begin, end = self._times[after - 1], self._times[after]
        return between(self._poses[after - 1], self._poses[after], (elapsed - begin) / (end - begin))


def between(first: ArmPose, second: ArmPose, share: float) -> ArmPose:
    """Return the pose that lies `share` (0 to 1) of the way from `first` to `second`, joint by joint."""

    def mixed(a: float, b: float) -> float:
        return a + share * (b - a)

    return ArmPose(
        mixed(first.rotation, second.rotation),
        mixed(first.shoulder, second.shoulder),
        mixed(first.elbow, second.elbow),
        mixed(first.claw, second.claw),
    )
