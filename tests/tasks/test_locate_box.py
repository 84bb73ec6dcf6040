"""A box around a thing in the rendered simulator: its width and height against the truth."""

import asyncio
from collections.abc import Awaitable, Callable

import numpy as np
import pytest

from estimation.things import Thing, ball, packet, tin
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ObjectTruth, ask_truth
from tapreach.geometry.pixel_box import PixelBox
from tapreach.tasks.floor_guess import floor_guess
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, TaskState
from tasks.rig import OPERATOR, Rig, running_rig, sim_robot


def in_scene(name: str, test: Callable[[Rig], Awaitable[None]]) -> None:
    async def run() -> None:
        async with running_rig(sim_robot(load_scene(name))) as rig:
            await rig.advance(0.3)
            await test(rig)

    asyncio.run(run())


def thing_of(truth: ObjectTruth) -> Thing:
    """The shape that truly stands there."""
    pose, (across, deep, high) = np.array(truth.world_from_object), truth.size
    foot = pose[:2, 3]
    if truth.kind == "box":
        return packet(foot, (across, deep, high), float(np.arctan2(pose[1, 0], pose[0, 0])))
    return ball(foot, across / 2) if truth.kind == "ball" else tin(foot, across / 2, high)


async def boxed(rig: Rig, name: str, slip: np.ndarray) -> tuple[Tap, tuple[float, float]]:
    """The box around a thing in the newest frame, edges `slip` [px] off; and its true width and height."""
    assert isinstance(rig.robot, InlineSimRobot)
    frame = rig.frames.store.newest
    assert frame is not None
    truth = await ask_truth(rig.robot, frame.captured_ns)
    thing, camera = thing_of(truth.object(name)), rig.robot.description.camera.model()
    box = thing.box(camera, truth.camera_pose)
    drawn = PixelBox(*(np.array([box.left, box.top, box.right, box.bottom]) + slip))
    return Tap.around(frame.frame_id, drawn), thing.size(truth.camera_pose)


@pytest.mark.parametrize("name", ["red can", "tea", "football"])
def test_boxed_thing_is_as_large_as_its_95_percent_say(name: str) -> None:
    async def test(rig: Rig) -> None:
        tap, size = await boxed(rig, name, np.array([-2.0, -1.5, 1.0, 2.0]))
        rig.runner.start(LocateTask(tap, 4), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.DONE, progress.message
        target = rig.targets[-1]
        assert tap.box is not None and tap.box.inner(0.8).left < target.u < tap.box.inner(0.8).right
        assert rig.targets[0].extent is None, "no size before there is a position"
        assert target.extent is not None
        found = target.extent.size
        assert found is not None and target.extent.reason == ""
        assert abs(found.width - size[0]) < 1.96 * found.width_sd
        assert abs(found.height - size[1]) < 1.96 * found.height_sd
        assert found.width_sd < 0.02 and found.height_sd < 0.03

    in_scene("room", test)


def test_box_on_the_floor_guesses_from_its_foot_at_once() -> None:
    async def test(rig: Rig) -> None:
        tap, size = await boxed(rig, "red can", np.zeros(4))
        guess = asyncio.ensure_future(floor_guess(rig.context, tap, 1))
        await rig.until(guess.done)
        target = guess.result()
        assert tap.box is not None and (target.u, target.v) == (tap.box.foot.u, tap.box.foot.v)
        assert target.extent is not None and target.extent.size is not None
        found = target.extent.size
        assert abs(found.width - size[0]) < 1.96 * found.width_sd
        assert abs(found.height - size[1]) < 1.96 * found.height_sd

    in_scene("room", test)


def test_box_cut_off_by_the_picture_says_at_which_edge() -> None:
    async def test(rig: Rig) -> None:
        frame = rig.frames.store.newest
        assert frame is not None
        tap = Tap.around(frame.frame_id, PixelBox(-40.0, 300.0, 90.0, 600.0))
        guess = asyncio.ensure_future(floor_guess(rig.context, tap, 1))
        await rig.until(guess.done)
        extent = guess.result().extent
        assert extent is not None
        assert extent.reason == "cut off at the picture's left and lower edge: at least so large"

    in_scene("room", test)
