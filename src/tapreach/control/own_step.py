"""What the robot does by itself once told, as a task's motion: a turn and an advance, or another move."""

from collections.abc import Callable

from tapreach.control.motion import Progress, Senses
from tapreach.errors import DriverError
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import STILL, Twist
from tapreach.robot.own_moves import MovesByItself, MoveStatus, OwnMove

READY_WITHIN_NS = 1 * SECOND
"""So long the wheels may take to come to rest before the robot begins."""
PROGRESS = {MoveStatus.MOVING: Progress.MOVING, MoveStatus.ARRIVED: Progress.ARRIVED}


class OwnMotion:
    """A move of the robot's own, kept alive by each `step` until it has ended.

    begin: begins it; raises DriverError where the robot is not ready yet. moves_arm: the wheels stand.
    """

    def __init__(self, begin: Callable[[], OwnMove], moves_arm: bool = False) -> None:
        self._begin, self.moves_arm = begin, moves_arm
        self._move: OwnMove | None = None
        self._asked_ns: int | None = None
        self.progress = Progress.MOVING
        self.reason = ""

    def step(self, senses: Senses, now_ns: int) -> Twist | None:
        """See Motion: None while the robot moves by itself, zero before and after."""
        if self.progress is Progress.MOVING:
            try:
                self._go_on(now_ns)
            except DriverError as error:
                self._wait_or_give_up(str(error), now_ns)
        turns_wheels = self._move is not None and not self.moves_arm
        return None if turns_wheels and self.progress is Progress.MOVING else STILL

    def _go_on(self, now_ns: int) -> None:
        if self._move is None:
            self._asked_ns = now_ns if self._asked_ns is None else self._asked_ns
            self._move = self._begin()
        self._move.keep()
        self.progress = PROGRESS.get(self._move.status, Progress.GIVEN_UP)
        if self.progress is Progress.GIVEN_UP:
            self.reason = self._move.reason

    def _wait_or_give_up(self, reason: str, now_ns: int) -> None:
        is_patient = self._asked_ns is not None and now_ns - self._asked_ns < READY_WITHIN_NS
        if self._move is not None or not is_patient:
            self.progress, self.reason = Progress.GIVEN_UP, reason


class OwnStep(OwnMotion):
    """A turn and an advance as one command to the robot; odometry tells what was done.

    share: of the speed that the robot usually takes for moves of its own.
    """

    def __init__(self, base: MovesByItself, step: PlanarStep, share: float = 1.0) -> None:
        super().__init__(lambda: base.drive_by(step, share))
