"""Tasks on the whole robot: an operator, a scene, a tap, and where things truly are."""

import asyncio

import numpy as np
from tests.firmware.sim.whole_robot import WholeRobot, described

from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.tasks.task import Tap
from tasks.rig import running_rig


def play(scene, scenario):
    """Run `scenario(rig)` with the robot in a scene."""

    async def run():
        async with running_rig(
            lambda clock: WholeRobot(described(rate_hz=10.0), load_scene(scene), clock)
        ) as rig:
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
