"""A whole fetch on the real machine code: board moves, servo pulses, and the thing in the claw at the end."""

import pytest
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.whole_rig import play, tap_on

from tapreach.drivers.sim.truth import ask_truth
from tapreach.tasks.fetch.states import Phase
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.task import TaskState
from tasks.rig import OPERATOR

pytestmark = [needs_bed, pytest.mark.timeout(400)]
LIFTED = 0.05


async def height_of(rig, name):
    return (await ask_truth(rig.robot)).object(name).centre_in_world[2]


def test_tapped_can_is_fetched_and_held():
    async def scenario(rig):
        before = await height_of(rig, "red can")
        tap, _ = await tap_on(rig, "red can")
        rig.runner.start(FetchTask(tap, 1), OPERATOR)
        progress = await rig.finish(120.0)
        assert progress.state is TaskState.DONE, progress
        assert rig.fetches[-1].phase is Phase.HELD
        assert await height_of(rig, "red can") > before + LIFTED
        assert rig.robot.health.is_running

    play("near", scenario)
