"""What each arm of the bench does about a tap."""

from collections.abc import Callable

from tapreach.bench.fetch_plan import Arm
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.fetch.ways import Ways
from tapreach.tasks.task import Tap


def _by(ways: Ways) -> Callable[[Tap], FetchTask]:
    return lambda tap: FetchTask(tap, target_id=1, ways=ways)


ARM_TASKS: dict[Arm, Callable[[Tap], FetchTask]] = {
    Arm.FULL: _by(Ways()),
    Arm.WITHOUT_BACKGROUND: _by(Ways(use_background=False)),
    Arm.WITHOUT_RENEWING: _by(Ways(renews_on_way=False)),
    Arm.FIXED_MOVE: _by(Ways(fixed_move=True)),
}
