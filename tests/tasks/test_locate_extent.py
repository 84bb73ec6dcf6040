"""A tapped thing in the rendered simulator: its width and height by the pictures taken while locating it."""

import asyncio

import numpy as np
import pytest

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.server.markers import Mark
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, TaskState
from tasks.rig import OPERATOR, Rig, running_rig, sim_robot


async def tap_on(rig: Rig, name: str) -> Tap:
    assert isinstance(rig.robot, InlineSimRobot)
    frame = rig.frames.store.newest
    assert frame is not None
    truth = await ask_truth(rig.robot, frame.captured_ns)
    centre = truth.camera_pose.inv().apply(np.array(truth.object(name).centre_in_world))
    u, v = rig.robot.description.camera.model().project(centre[None]).pixels[0]
    return Tap(frame.frame_id, float(u), float(v))


def test_tapped_thing_is_shown_as_large_as_it_is() -> None:
    async def run() -> None:
        async with running_rig(sim_robot(load_scene("room"))) as rig:
            await rig.advance(0.3)
            task = LocateTask(await tap_on(rig, "red can"), 4)
            rig.runner.start(task, OPERATOR)
            progress = await rig.finish()
            assert progress.state is TaskState.DONE, progress.message
            assert all(target.extent is None for target in rig.targets[:-1]), "measured once, at the end"
            extent = rig.targets[-1].extent
            assert extent is not None and extent.size is not None, extent
            assert abs(extent.size.width - 0.066) < max(0.008, 1.96 * extent.size.width_sd)
            assert abs(extent.size.height - 0.115) < max(0.015, 1.96 * extent.size.height_sd)
            assert "by the picture" in extent.reason
            mark = Mark.of(rig.targets[-1])
            assert mark is not None and mark.corners == 4
            corners = extent.size.corners_in_world
            assert np.ptp(corners[:, 2]) == pytest.approx(extent.size.height)
            ahead, across = corners.mean(axis=0), corners[1] - corners[0]
            assert ahead[0] * across[1] - ahead[1] * across[0] < 0.0, "left comes first"

    asyncio.run(run())
