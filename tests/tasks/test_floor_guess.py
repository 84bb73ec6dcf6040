"""A position from one view: right on the floor, honest about its error, refused at the horizon."""

import asyncio
from dataclasses import replace

import numpy as np
import pytest

from tapreach.errors import FrameUnknown, InputError, PoseNotYetKnown
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND
from tapreach.robot.messages import Frame
from tapreach.tasks.floor_guess import floor_guess, target_on_floor
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target import Target
from tapreach.tasks.task import Tap, TaskContext
from tasks.rig import bare_context, sim_description

POSE = PlanarPose(0.7, -0.4, 0.6)
CAPTURED_NS = 5 * SECOND


def context_with_frame() -> TaskContext:
    context = bare_context()
    size = ImageSize(640, 480)
    context.frames.add(Frame(1, CAPTURED_NS, CAPTURED_NS, size, b""))
    context.poses.add(CAPTURED_NS - SECOND, POSE)
    context.poses.add(CAPTURED_NS + SECOND, POSE)
    return context


def pixel_of(point_in_base: tuple[float, float, float]) -> Pixel:
    description = sim_description()
    in_camera = description.camera.mount.base_from_camera().inv().apply(np.array(point_in_base))
    return Pixel(*map(float, description.camera.model().project(in_camera[None]).pixels[0]))


def guess(point_in_base: tuple[float, float, float]) -> Target:
    pixel = pixel_of(point_in_base)
    return asyncio.run(floor_guess(context_with_frame(), Tap(1, pixel.u, pixel.v), 3))


def test_point_on_the_floor_is_found_in_the_world() -> None:
    target = guess((1.1, 0.2, 0.0))
    assert target.point_in_world is not None and target.range is not None
    expected = POSE.to_rigid().apply(np.array([1.1, 0.2, 0.0]))
    np.testing.assert_allclose(target.point_in_world, expected, atol=1e-6)
    assert target.range == pytest.approx(np.hypot(1.1, 0.2), abs=1e-6)
    assert (target.source, target.frame_id, target.target_id) == ("floor", 1, 3)
    assert "floor" in target.reason


def test_region_is_longest_along_the_line_of_sight() -> None:
    target = guess((1.5, 0.0, 0.0))
    assert target.point_cov_in_world is not None
    along = np.array([np.cos(POSE.heading), np.sin(POSE.heading), 0.0])
    across = np.array([-along[1], along[0], 0.0])
    cov = target.point_cov_in_world
    assert along @ cov @ along > 4.0 * (across @ cov @ across)


def test_interval_is_lopsided_and_holds_the_range() -> None:
    target = guess((1.5, 0.0, 0.0))
    assert target.range is not None and target.range_interval is not None
    near, far = target.range_interval
    assert near < target.range < far
    assert far - target.range > target.range - near


def test_mount_error_of_one_sigma_stays_in_the_region() -> None:
    description = sim_description()
    mount = description.camera.mount
    tilted = mount.model_copy(update={"pitch_deg": mount.pitch_deg + mount.angle_sigma_deg})
    wrong = description.model_copy(update={"camera": description.camera.model_copy(update={"mount": tilted})})
    sighting = Sighting(1, 1, pixel_of((1.2, 0.1, 0.0)), 3.0, 1.0, PlanarPose())
    target = target_on_floor(sighting, 1, wrong)
    assert target.point_in_world is not None and target.point_cov_in_world is not None
    error = (target.point_in_world - [1.2, 0.1, 0.0])[:2]
    mahalanobis = error @ np.linalg.solve(target.point_cov_in_world[:2, :2], error)
    assert 0.3 < mahalanobis < 3.0


def test_above_the_horizon_has_no_position_but_a_reason() -> None:
    context = context_with_frame()
    target = asyncio.run(floor_guess(context, Tap(1, 320.0, 10.0), 1))
    assert target.point_in_world is None and target.range is None
    assert (target.status, "horizon" in target.reason) == ("above_horizon", True)
    assert "locate" in target.advice


def test_near_the_horizon_has_no_position_but_a_reason() -> None:
    description = sim_description()
    pixel = pixel_of((30.0, 0.0, 0.0))
    target = target_on_floor(Sighting(1, 1, pixel, 3.0, 1.0, PlanarPose()), 1, description)
    assert (target.status, target.point_in_world) == ("near_horizon", None)


def test_bad_taps_are_errors() -> None:
    context = context_with_frame()
    with pytest.raises(FrameUnknown):
        asyncio.run(floor_guess(context, Tap(2, 1.0, 1.0), 1))
    with pytest.raises(InputError, match="outside"):
        asyncio.run(floor_guess(context, Tap(1, 1.0, 480.0), 1))
    with pytest.raises(InputError, match="nan"):
        asyncio.run(floor_guess(context, Tap(1, float("nan"), 1.0), 1))


def test_pose_that_never_comes_is_an_error_after_a_second() -> None:
    context = context_with_frame()
    later = replace(context, frames=context.frames)
    later.frames.add(Frame(2, CAPTURED_NS + 60 * SECOND, 0, ImageSize(640, 480), b""))

    async def run() -> None:
        waiting = asyncio.create_task(floor_guess(later, Tap(2, 300.0, 400.0), 1))
        await later.clock.advance(2 * SECOND)  # type: ignore[attr-defined]
        with pytest.raises(PoseNotYetKnown):
            await waiting

    asyncio.run(run())
