"""What each arm of the bench does about a tap."""

from collections.abc import Callable

from tapreach.bench.locate_fixed import FixedMove
from tapreach.bench.locate_plan import Arm
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, Task

ARM_TASKS: dict[Arm, Callable[[Tap], Task]] = {
    Arm.CHOSEN: lambda tap: LocateTask(tap, target_id=1),
    Arm.WITHOUT_BACKGROUND: lambda tap: LocateTask(tap, target_id=1, use_background=False),
    Arm.FIXED: FixedMove,
}
