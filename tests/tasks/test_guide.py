"""The guided procedures with a robot: what the steps tell, what the robot does for them, what comes out."""

import asyncio
from collections.abc import Awaitable, Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.errors import FrameUnknown, InputError
from tapreach.tasks.guide import Guide
from tapreach.tasks.guide_state import GuideKind, GuideState
from tapreach.tasks.task import Tap, TaskState
from tasks.rig import OPERATOR, Rig, running_rig, sim_robot


def guided(kind: GuideKind, test: Callable[[Rig, Guide, list[GuideState]], Awaitable[None]]) -> None:
    async def run() -> None:
        async with running_rig(sim_robot(load_scene("room"))) as rig:
            await rig.advance(0.3)
            states: list[GuideState] = []
            guide = Guide(rig.context, rig.runner, kind, OPERATOR, 5, states.append)
            await guide.start()
            await test(rig, guide, states)
            await guide.end()
            assert guide.state.kind is None and states[-1].kind is None

    asyncio.run(run())


async def pixel_of(rig: Rig, point: NDArray[np.float64]) -> Tap:
    """A perfect tap on a point of the world in the newest frame."""
    assert isinstance(rig.robot, InlineSimRobot)
    frame = rig.frames.store.newest
    assert frame is not None
    truth = await ask_truth(rig.robot, frame.captured_ns)
    camera = rig.robot.description.camera.model()
    u, v = map(float, camera.project(truth.camera_pose.inv().apply(point)[None]).pixels[0])
    return Tap(frame.frame_id, u, v)


async def done_by_robot(rig: Rig, guide: Guide, act: str) -> None:
    await guide.act(act)
    progress = await rig.finish()
    assert progress.state is TaskState.DONE, progress.message
    await rig.advance(0.4)


def test_two_tap_walked_through_with_the_robots_help() -> None:
    async def test(rig: Rig, guide: Guide, states: list[GuideState]) -> None:
        assert isinstance(rig.robot, InlineSimRobot)
        can = np.array((await ask_truth(rig.robot)).object("red can").centre_in_world)
        assert (guide.state.step, guide.state.steps, guide.state.title) == (1, 6, "Standard pose")
        await done_by_robot(rig, guide, "pose")
        await guide.act("next")
        await guide.tap(await pixel_of(rig, can))
        assert guide.state.hint.startswith("turn ") and guide.state.hint.endswith("left")
        await done_by_robot(rig, guide, "centre")
        await guide.tap(await pixel_of(rig, can))
        assert abs((await pixel_of(rig, can)).u - 319.5) < 15.0
        await guide.act("next")
        await guide.tap(await pixel_of(rig, can))
        assert guide.state.title == "Turn left"
        await done_by_robot(rig, guide, "turn")
        assert guide.state.theta_deg == pytest.approx(12.0, abs=0.7)
        assert "of 12° left" in guide.state.hint
        await guide.act("next")
        await done_by_robot(rig, guide, "advance")
        assert guide.state.distance == pytest.approx(0.20, abs=0.01)
        await guide.act("next")
        assert guide.state.wants_tap
        await guide.tap(await pixel_of(rig, can))
        text = guide.state.result
        assert "OQ1" in text and "Height check (11)" in text and "Modelled" in text
        target = rig.targets[-1]
        assert (target.target_id, target.source) == (5, "two_tap")
        assert target.point_in_world is not None
        assert np.linalg.norm(target.point_in_world - can) < 0.03
        await guide.value("theta_deg", 90.0)
        assert guide.state.values_typed == ("theta_deg",)
        assert "no answer" in guide.state.result
        await guide.value("theta_deg", None)
        assert guide.state.result == text

    guided(GuideKind.TWO_TAP, test)


def test_rotation_centre_check_finds_the_simulated_lever() -> None:
    async def test(rig: Rig, guide: Guide, states: list[GuideState]) -> None:
        near, far = np.array([0.6, 0.0, 0.0]), np.array([1.7, 0.05, 0.0])
        await guide.act("next")
        await guide.tap(await pixel_of(rig, near))
        await guide.tap(await pixel_of(rig, far))
        await done_by_robot(rig, guide, "turn")
        await guide.act("next")
        await guide.tap(await pixel_of(rig, near))
        await guide.tap(await pixel_of(rig, far))
        assert "robot file says 10.0 cm" in guide.state.result
        lever = float(guide.state.result.split("camera is ")[1].split(" ")[0])
        assert lever == pytest.approx(10.0, abs=2.5)

    guided(GuideKind.ROTATION_CENTRE, test)


def test_refusals_are_sentences_and_change_nothing() -> None:
    async def test(rig: Rig, guide: Guide, states: list[GuideState]) -> None:
        with pytest.raises(InputError, match="'advance' is not on offer"):
            await guide.act("advance")
        with pytest.raises(InputError, match="takes no tap"):
            await guide.tap(await pixel_of(rig, np.array([0.8, 0.0, 0.0])))
        await guide.act("next")
        with pytest.raises(FrameUnknown):
            await guide.tap(Tap(10_000, 1.0, 1.0))
        with pytest.raises(InputError, match="outside"):
            await guide.tap(Tap(1, -5.0, 1.0))
        with pytest.raises(InputError, match="distance"):
            await guide.value("distance", float("nan"))
        assert guide.state.step == 2

    guided(GuideKind.TWO_TAP, test)


def test_leaving_the_guide_stops_its_move() -> None:
    async def test(rig: Rig, guide: Guide, states: list[GuideState]) -> None:
        await guide.act("next")
        await guide.tap(await pixel_of(rig, np.array([1.0, 0.3, 0.0])))
        await guide.act("centre")
        await rig.until(lambda: not rig.loop.sent.twist.is_zero)
        await guide.end()
        assert rig.loop.sent.twist.is_zero
        assert (await rig.finish()).state is TaskState.CANCELLED

    guided(GuideKind.TWO_TAP, test)


def test_odometry_is_told_only_when_a_person_would_see_it() -> None:
    async def test(rig: Rig, guide: Guide, states: list[GuideState]) -> None:
        before = len(states)
        await rig.advance(1.0)
        assert len(states) <= before + 2, "a robot at rest fills no socket"

    guided(GuideKind.TWO_TAP, test)
