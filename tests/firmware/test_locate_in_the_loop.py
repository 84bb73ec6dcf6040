"""One tap to a position on the real machine code: task, control loop, driver, firmware, physics, pictures."""

import numpy as np
import pytest
from tests.firmware.sim.avr import ResetCause
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.whole_rig import in_odometry, play, tap_on

from tapreach.geometry.gaussian import chi2_limit, squared_mahalanobis
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import TaskState
from tasks.rig import OPERATOR

pytestmark = needs_bed


def test_tapped_object_is_located_within_its_region():
    async def scenario(rig):
        tap, truth = await tap_on(rig, "red can")
        rig.runner.start(LocateTask(tap, 4), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.DONE, progress.message
        target = rig.targets[-1]
        error = target.point_in_world - await in_odometry(rig, truth)
        assert np.linalg.norm(error) < 0.02 * np.linalg.norm(truth)
        assert squared_mahalanobis(error, target.point_cov_in_world) < chi2_limit(0.9999, 3)
        assert rig.loop.sent.twist.is_zero
        assert rig.loop.senses.odometry.distance > 0.1

    play("room", scenario)


@pytest.mark.parametrize(
    ("cause", "words"), [(ResetCause.BROWN_OUT, "supply broke down"), (ResetCause.WATCHDOG, "program hung")]
)
def test_reset_on_the_way_stops_the_wheels_and_the_task_says_so(cause, words):
    async def scenario(rig):
        tap, _ = await tap_on(rig, "red can")
        rig.runner.start(LocateTask(tap, 4), OPERATOR)
        await rig.until(lambda: rig.robot.rover.powered_us() > 400_000)
        rig.robot.rover.reset(cause)
        reset_us = rig.robot.rover.now_us
        progress = await rig.finish()
        assert progress.state is TaskState.FAILED
        assert words in progress.message
        await rig.advance(1.0)
        assert rig.robot.rover.off_since_us() <= reset_us + 20_000

    play("room", scenario)
