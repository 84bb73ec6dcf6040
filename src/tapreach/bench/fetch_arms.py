"""What each arm of the bench does about a tap."""

from collections.abc import Callable

from tapreach.bench.fetch_plan import Arm
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.task import Tap

ARM_TASKS: dict[Arm, Callable[[Tap], FetchTask]] = {Arm.FULL: lambda tap: FetchTask(tap, target_id=1)}
