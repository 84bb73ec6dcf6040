"""Automatic locating: one tap; the robot moves a little, follows the tapped place, and says where it is."""

from tapreach.robot.held_settings import settings_held
from tapreach.tasks.aiming import aimed
from tapreach.tasks.camera_delay import is_worth_measuring, know_delay
from tapreach.tasks.follower import Follower
from tapreach.tasks.locating import Locating
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap, TaskContext

ACCURACY = 0.01
"""Relative error of the range, one sigma, that is wanted unless said otherwise."""


class LocateTask:
    """Locate what was tapped. Shows the target under `target_id` from the first moment on.

    accuracy: the relative error of the range, one sigma, at which it is good enough.
    """

    kind = "locate"

    def __init__(
        self, tap: Tap, target_id: int, use_background: bool = True, accuracy: float = ACCURACY
    ) -> None:
        self._tap = tap
        self._target_id = target_id
        self._use_background = use_background
        self._accuracy = accuracy

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises FrameError, InputError, TargetLost, MotionInterrupted, LinkLost."""
        with settings_held(context.robot.frames):
            return await self._locate(context)

    async def _locate(self, context: TaskContext) -> str:
        tap = await aimed(context, self._tap)
        if is_worth_measuring(context):
            await know_delay(context)
        follower = Follower(context, tap, key=self._target_id, uses_background=self._use_background)
        report = TargetReport(self._target_id, TargetSource.LOCATE, tap, context.description)
        try:
            return await Locating(context, follower, report, self._accuracy).run()
        finally:
            context.show_move(None)
            await follower.close()
