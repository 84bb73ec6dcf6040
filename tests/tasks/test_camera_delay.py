"""A camera that is later than its robot file says: found out by a turn, kept, and taken off everywhere."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import replace
from math import degrees

import cv2
import numpy as np
import pytest

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.estimation.camera_delay import CameraDelay, NoDelay
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, ManualClock
from tapreach.robot.messages import Frame
from tapreach.tasks.camera_delay import in_words, is_worth_measuring, know_delay
from tapreach.tasks.delay_kept import DelayKept
from tapreach.tasks.follower import Follower
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.task import Tap, TaskContext, TaskReport, TaskState
from tasks.rig import OPERATOR, Doing, Rig, bare_context, running_rig, sim_description


def late_robot(delay_ms: float, rate_hz: float) -> Callable[[ManualClock], InlineSimRobot]:
    faults = SimFaults(camera_delay_ms=delay_ms, dropped_frames=0.05, wheel_left_error=0.01)
    seed = int(np.random.default_rng().integers(1 << 31))
    description = sim_description(rate_hz)
    return lambda clock: InlineSimRobot(description, load_scene("room"), clock, faults, seed, shadows=False)


def with_late_robot(delay_ms: float, test: Callable[[Rig], Awaitable[None]], rate_hz: float = 10.0) -> None:
    async def run() -> None:
        async with running_rig(late_robot(delay_ms, rate_hz)) as rig:
            await rig.advance(0.6)
            await test(rig)

    asyncio.run(run())


async def done(rig: Rig, do: Callable[[TaskContext], Awaitable[object]]) -> None:
    rig.runner.start(Doing(do), OPERATOR)
    progress = await rig.finish()
    assert progress.state is TaskState.DONE, progress.message


def test_delay_is_measured_by_turning_kept_and_told() -> None:
    async def test(rig: Rig) -> None:
        began_ns, before = rig.clock.now_ns(), rig.context.poses.newest()[1]
        await done(rig, know_delay)
        known, after = rig.context.camera_delay.known, rig.context.poses.newest()[1]
        assert known is not None
        assert known.delay == pytest.approx(0.08, abs=0.004)
        assert rig.clock.now_ns() - began_ns < 4000 * MS
        assert abs(degrees(after.heading - before.heading)) < 3.0
        assert [report.message for report in rig.progress if "late" in report.message]
        moved_ns = rig.clock.now_ns()
        await done(rig, know_delay)
        assert rig.clock.now_ns() - moved_ns < 50 * MS, "what is known is not measured again"
        await poses_are_those_of_the_pictures(rig)

    with_late_robot(80.0, test, rate_hz=15.0)


async def poses_are_those_of_the_pictures(rig: Rig) -> None:
    """Poses of a turn are off by no more than a third of the 3.4° that 80 ms make at 0.75 rad/s."""
    off: list[float] = []

    async def watched(context: TaskContext) -> None:
        turning = asyncio.ensure_future(context.pilot.turn(-0.35))
        frame_id = 0
        while not turning.done():
            frame = await context.next_frame(frame_id)
            frame_id = frame.frame_id
            by_wheels = (await pose_at(context, frame.captured_ns)).heading
            truth = await ask_truth(rig.robot, frame.captured_ns - 80 * MS)  # type: ignore[arg-type]
            off.append(degrees(truth.base_pose.heading - by_wheels))

    await done(rig, watched)
    assert len(off) > 5
    assert np.ptp(off) < 1.1


def test_sighting_at_rest_is_made_of_pictures_taken_at_rest() -> None:
    """The pictures of the last 150 ms of a turn arrive when it is over."""

    async def test(rig: Rig) -> None:
        rig.context.camera_delay.known = CameraDelay(0.15, 0.002)
        taken: list[float] = []

        async def turned_and_looked(context: TaskContext) -> None:
            frame = await context.next_frame(0)
            follower = Follower(context, Tap(frame.frame_id, 320.0, 200.0), key=1)
            await follower.open()
            await context.pilot.move(PlanarStep(0.2, 0.0))
            rest_ns = context.clock.now_ns()
            seen = await follower.look(3)
            first = context.frames.since(follower.frame_id - 3)[0]
            taken.append((first.captured_ns - 150 * MS - rest_ns) / MS)
            assert seen is None or seen.frame_id == follower.frame_id
            await follower.close()

        await done(rig, turned_and_looked)
        assert taken[0] >= -1.0

    with_late_robot(150.0, test)


def test_camera_that_sees_nothing_is_taken_at_its_word() -> None:
    async def test(rig: Rig) -> None:
        rig.frames.change = wall
        said: list[str] = []

        def hear(report: TaskReport) -> None:
            said.append(report.message)

        await done(rig, lambda context: know_delay(replace(context, report=hear)))
        assert rig.context.camera_delay.known is None
        assert rig.context.camera_delay.taken_ns(123) == 123
        assert said[-1].startswith("how late the camera is cannot be told: only 0 places")

    with_late_robot(80.0, test)


def wall(frame: Frame) -> Frame:
    _, jpeg = cv2.imencode(".jpg", np.full((480, 640), 140, np.uint8))
    return replace(frame, jpeg=jpeg.tobytes())


def test_delay_is_worth_measuring_where_the_robot_file_does_not_know_it() -> None:
    context = bare_context()
    assert not is_worth_measuring(context), "the simulator stamps its pictures to half a millisecond"
    camera = context.description.camera.model_copy(update={"timing_sigma_ms": 4.0})
    real = context.description.model_copy(update={"camera": camera})
    assert is_worth_measuring(replace(context, description=real))


def test_stamps_count_as_they_are_until_a_delay_is_known() -> None:
    kept = DelayKept()
    assert kept.taken_ns(5_000) == 5_000
    assert kept.timing_sigma(4.0) == pytest.approx(0.004)
    kept.known = CameraDelay(0.0821, 0.0015, 0.002)
    assert kept.taken_ns(100 * MS) == 100 * MS - 82_100_000
    assert kept.timing_sigma(4.0) == pytest.approx(0.0025)


def test_result_is_told_in_words() -> None:
    assert in_words(CameraDelay(0.0821, 0.0015)) == "the camera is 82 ms late (give or take 3.0 ms)"
    assert in_words(CameraDelay(-0.02, 0.001)) == "the camera is 20 ms early (give or take 2.0 ms)"
    assert in_words(NoDelay("why")) == "how late the camera is cannot be told: why"
