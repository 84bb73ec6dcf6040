"""Locating and fetching hold the camera's settings, and let them go however they end."""

import asyncio
from collections.abc import Callable

import pytest

from tapreach.drivers.sim.scene import load_scene
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, Task, TaskState
from tasks.rig import OPERATOR, Rig, running_rig, sim_robot


class Held:
    """Stands in for the simulator's camera, which has no settings."""

    def __init__(self, rig: Rig) -> None:
        self.count, self.times = 0, 0
        rig.robot.frames.hold_settings = self.hold_settings  # type: ignore[attr-defined]

    def hold_settings(self) -> Callable[[], None]:
        self.count += 1
        self.times += 1
        return self._release

    def _release(self) -> None:
        self.count -= 1


TASKS: list[Callable[[Tap], Task]] = [
    lambda tap: LocateTask(tap, 4),
    lambda tap: FetchTask(tap, 4, Mode.PLAN),
]


@pytest.mark.parametrize("make", TASKS, ids=["locate", "fetch"])
@pytest.mark.parametrize("how", ["stop", "error"])
def test_settings_are_held_while_it_looks_and_released_after_a_stop_or_an_error(
    make: Callable[[Tap], Task], how: str
) -> None:
    async def run() -> None:
        async with running_rig(sim_robot(load_scene("room"))) as rig:
            await rig.advance(0.3)
            held = Held(rig)
            frame = rig.frames.store.newest
            assert frame is not None
            rig.runner.start(make(Tap(frame.frame_id, 320.0, 300.0)), OPERATOR)
            await rig.until(lambda: held.count == 1)
            if how == "stop":
                rig.runner.cancel("stopped")
            else:
                rig.frames.is_silent = True
            progress = await rig.finish()
            assert progress.state is (TaskState.CANCELLED if how == "stop" else TaskState.FAILED)
            assert (held.count, held.times) == (0, 1)

    asyncio.run(run())
