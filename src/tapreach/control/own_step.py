"""A turn and an advance that the robot makes by itself, as a task's motion."""

from tapreach.control.motion import Progress, Senses
from tapreach.errors import DriverError
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import STILL, Twist
from tapreach.robot.own_moves import MovesByItself, MoveStatus, OwnMove

READY_WITHIN_NS = 1 * SECOND
"""So long the wheels may take to come to rest before the robot begins."""
PROGRESS = {MoveStatus.MOVING: Progress.MOVING, MoveStatus.ARRIVED: Progress.ARRIVED}


class OwnStep:
    """One command to the robot, kept alive by each `step` until it has ended; odometry tells what was done.

    share: of the speed that the robot usually takes for moves of its own.
    """

    moves_arm = False

    def __init__(self, base: MovesByItself, step: PlanarStep, share: float = 1.0) -> None:
        self._base, self._wanted, self._share = base, step, share
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
        return None if self._move is not None and self.progress is Progress.MOVING else STILL

    def _go_on(self, now_ns: int) -> None:
        if self._move is None:
            self._asked_ns = now_ns if self._asked_ns is None else self._asked_ns
            self._move = self._base.drive_by(self._wanted, self._share)
        self._move.keep()
        self.progress = PROGRESS.get(self._move.status, Progress.GIVEN_UP)
        if self.progress is Progress.GIVEN_UP:
            self.reason = self._move.reason

    def _wait_or_give_up(self, reason: str, now_ns: int) -> None:
        is_patient = self._asked_ns is not None and now_ns - self._asked_ns < READY_WITHIN_NS
        if self._move is not None or not is_patient:
            self.progress, self.reason = Progress.GIVEN_UP, reason
