"""One tap to a position on the real machine code: task, control loop, driver, firmware, physics, pictures."""

import asyncio

import numpy as np
import pytest
from tests.firmware.sim.avr import ResetCause
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.whole_robot import WholeRobot

from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.geometry.gaussian import chi2_limit, squared_mahalanobis
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, TaskState
from tasks.rig import OPERATOR, running_rig

pytestmark = needs_bed


def play(scenario):
    async def run():
        async with running_rig(lambda clock: WholeRobot(load_scene("room"), clock)) as rig:
            await rig.advance(0.5)
            assert rig.robot.health.is_running, rig.robot.health
            await scenario(rig)

    asyncio.run(run())


async def tap_on(rig, name):
    """A tap on the middle of an object as it is seen, and the point of its surface there."""
    frame, camera = rig.frames.store.newest, rig.robot.description.camera.model()
    truth = await ask_truth(rig.robot, frame.captured_ns)
    middle = truth.camera_pose.inv().apply(np.array(truth.object(name).centre_in_world))
    u, v = map(float, camera.project(middle[None]).pixels[0])
    (hit,) = rig.robot.surfaces_seen(camera.unproject([[u, v]]), frame.captured_ns)
    assert hit.name == name
    return Tap(frame.frame_id, u, v), hit.point_in_world


async def in_odometry(rig, point):
    """Where a point is in the world that the pose by the wheels is exact in."""
    captured_ns, by_wheels = rig.context.poses.newest()
    camera = (await ask_truth(rig.robot, captured_ns)).camera_pose
    world_from_base = camera * rig.robot.description.camera.mount.base_from_camera().inv()
    return by_wheels.to_rigid().apply(world_from_base.inv().apply(point))


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

    play(scenario)


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

    play(scenario)
