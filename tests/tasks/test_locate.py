"""One tap to a position, against the truth of rendered scenes; and every way it can end otherwise."""

import asyncio
from collections.abc import Awaitable, Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.geometry.gaussian import chi2_limit, squared_mahalanobis
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import Frame
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, TaskState
from tasks.rig import OPERATOR, Rig, running_rig, sim_robot, tapped_surface


def in_scene(name: str, test: Callable[[Rig], Awaitable[None]]) -> None:
    async def run() -> None:
        async with running_rig(sim_robot(load_scene(name))) as rig:
            await rig.advance(0.3)
            await test(rig)

    asyncio.run(run())


async def tap_on(rig: Rig, name: str) -> tuple[Tap, NDArray[np.float64]]:
    """A tap on the middle of an object as it is seen, and the point of its surface there."""
    assert isinstance(rig.robot, InlineSimRobot)
    frame = rig.frames.store.newest
    assert frame is not None
    truth = await ask_truth(rig.robot, frame.captured_ns)
    camera = rig.robot.description.camera.model()
    middle = truth.camera_pose.inv().apply(np.array(truth.object(name).centre_in_world))
    u, v = map(float, camera.project(middle[None]).pixels[0])
    hit = await tapped_surface(rig.robot, frame.captured_ns, u, v)
    assert hit is not None and hit[0] == name, f"{name} is hidden behind {hit}"
    return Tap(frame.frame_id, u, v), hit[1]


async def in_odometry(rig: Rig, point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where a point is, seen from the true base, in the world that the wheels' pose of the base is exact in:
    the robot may have run into something on its way.
    """
    assert isinstance(rig.robot, InlineSimRobot)
    captured_ns, by_wheels = rig.context.poses.newest()
    camera = (await ask_truth(rig.robot, captured_ns)).camera_pose
    world_from_base = camera * rig.robot.description.camera.mount.base_from_camera().inv()
    return np.asarray(by_wheels.to_rigid().apply(world_from_base.inv().apply(point)))


@pytest.mark.parametrize("name", ["red can", "parcel"])
def test_tapped_object_is_located_within_its_region(name: str) -> None:
    async def test(rig: Rig) -> None:
        tap, truth = await tap_on(rig, name)
        rig.runner.start(LocateTask(tap, 4), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.DONE, progress.message
        target = rig.targets[-1]
        assert target.target_id == 4 and target.status == "determined", target
        assert target.point_in_world is not None and target.point_cov_in_world is not None
        error = target.point_in_world - await in_odometry(rig, truth)
        distance = float(np.linalg.norm(truth))
        assert np.linalg.norm(error) < 0.05 * distance
        assert squared_mahalanobis(error, target.point_cov_in_world) < chi2_limit(0.9999, 3)
        assert target.range is not None and target.range_interval is not None
        assert target.range_interval[0] < target.range < target.range_interval[1]
        assert "m away (95 %" in progress.message
        assert rig.loop.sent.twist.is_zero
        phases = {each.phase for each in rig.progress}
        assert {"look", "move"} <= phases
        told = [each.message for each in rig.progress if "driving" in each.message]
        assert told, "the move is told before it is made"
        assert rig.moves[-1] is None and rig.moves[0] is not None, "and shown"
        assert rig.moves[0].in_words == told[0]

    in_scene("room", test)


def test_no_more_is_driven_than_the_wanted_accuracy_asks_for() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        rig.runner.start(LocateTask(tap, 1, accuracy=0.2), OPERATOR)
        progress = await rig.finish()
        assert "20 % was wanted" in progress.message
        (planned,) = [move for move in rig.moves if move is not None]
        assert rig.loop.senses.odometry is not None
        assert rig.loop.senses.odometry.distance < 0.12
        assert planned.expected_relative_sd <= 0.2
        assert rig.loop.sent.twist.is_zero

    in_scene("room", test)


def test_cancel_on_the_way_stops_at_once_and_ends_the_task() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        rig.runner.start(LocateTask(tap, 1), OPERATOR)
        await rig.until(lambda: not rig.loop.sent.twist.is_zero)
        assert rig.runner.cancel("stop button")
        assert rig.loop.sent.twist.is_zero, "before anything else runs"
        progress = await rig.finish()
        assert (progress.state, progress.message) == (TaskState.CANCELLED, "stop button")
        await rig.advance(0.5)
        assert rig.loop.sent.twist.is_zero

    in_scene("room", test)


def test_camera_that_falls_silent_ends_it_with_a_sentence() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        rig.runner.start(LocateTask(tap, 1), OPERATOR)
        await rig.until(lambda: not rig.loop.sent.twist.is_zero)
        rig.frames.is_silent = True
        progress = await rig.finish()
        assert progress.state is TaskState.FAILED
        assert "no picture" in progress.message
        assert rig.loop.sent.twist.is_zero

    in_scene("room", test)


def test_place_that_disappears_is_lost_with_a_reason() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        shown = rig.frames.store.newest
        assert shown is not None
        rng = np.random.default_rng(0)
        rig.frames.change = lambda frame: Frame(
            frame.frame_id, frame.captured_ns, frame.received_ns, frame.size, noise_jpeg(rng)
        )
        rig.runner.start(LocateTask(tap, 1), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.FAILED
        assert progress.message.startswith("lost the tapped place")
        assert not rig.targets[-1].is_following
        assert rig.clock.now_ns() < 20 * SECOND

    in_scene("room", test)


def noise_jpeg(rng: np.random.Generator) -> bytes:
    import cv2

    return bytes(cv2.imencode(".jpg", rng.integers(0, 255, (480, 640)).astype(np.uint8))[1])


@pytest.mark.parametrize(
    ("tap", "words"),
    [
        (Tap(9999, 10.0, 10.0), "no picture 9999"),
        (Tap(1, 10.0, 10.0), "no longer kept"),
        (Tap(0, 640.0, 10.0), "outside the picture"),
        (Tap(0, float("nan"), 10.0), "nan"),
    ],
    ids=["unknown frame", "expired frame", "outside", "nan"],
)
def test_bad_tap_is_a_sentence_and_moves_nothing(tap: Tap, words: str) -> None:
    async def test(rig: Rig) -> None:
        rig.frames.store._keep_ns = SECOND // 2
        await rig.advance(0.6)
        newest = rig.frames.store.newest
        assert newest is not None
        rig.runner.start(LocateTask(Tap(tap.frame_id or newest.frame_id, tap.u, tap.v), 1), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.FAILED
        assert words in progress.message
        assert rig.targets == []

    in_scene("room", test)
