"""The lines that a guided procedure ends with, for taps made from known points."""

import asyncio

import numpy as np
import pytest
from numpy.typing import ArrayLike

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.guide_progress import GuideProgress
from tapreach.tasks.guide_result import GuideResult, result_of
from tapreach.tasks.guide_state import GuideKind
from tapreach.tasks.guide_steps import ROTATION_CENTRE, TWO_TAP
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import TaskContext
from tasks.rig import bare_context

STEP = PlanarStep(np.radians(12.0), 0.2)


def seen(point: ArrayLike, pose: PlanarPose, description: RobotDescription) -> Sighting:
    world_from_camera = pose.to_rigid() * description.camera.mount.base_from_camera()
    in_camera = world_from_camera.inv().apply(np.asarray(point, dtype=float))
    projection = description.camera.model().project(in_camera[None])
    assert projection.is_inside[0]
    return Sighting(1, 1, Pixel(*map(float, projection.pixels[0])), 1.0, 1.0, pose)


def mounted(context: TaskContext, **mount: float) -> RobotDescription:
    camera = context.description.camera
    changed = camera.model_copy(update={"mount": camera.mount.model_copy(update=mount)})
    return context.description.model_copy(update={"camera": changed})


def two_tap_result(
    point: ArrayLike, second: PlanarPose, description: RobotDescription, typed: dict[str, float] | None = None
) -> GuideResult:
    from dataclasses import replace

    context = replace(bare_context(), description=description)
    taps = {"first": seen(point, PlanarPose(), description), "second": seen(point, second, description)}
    progress = GuideProgress(TWO_TAP, 5, taps, typed or {})
    return asyncio.run(result_of(context, GuideKind.TWO_TAP, progress, 3))


def test_camera_of_the_paper_gives_the_same_answer_twice() -> None:
    description = mounted(bare_context(), forward=0.0, pitch_deg=0.0)
    result = two_tap_result((0.9, 0.0, 0.06), STEP.to_pose(), description)
    assert "OQ1 = 0.900 m" in result.text
    assert "differ by 0.0 cm" in result.text
    assert result.target is not None and result.target.point_in_world is not None
    np.testing.assert_allclose(result.target.point_in_world, (0.9, 0.0, 0.06), atol=1e-3)


def test_lever_and_pitch_bias_the_paper_and_not_the_model() -> None:
    result = two_tap_result((0.9, 0.0, 0.06), STEP.to_pose(), bare_context().description)
    assert "OQ1 = 0.900 m" not in result.text
    assert "so the two may differ" in result.text
    assert result.target is not None and result.target.point_in_world is not None
    np.testing.assert_allclose(result.target.point_in_world, (0.9, 0.0, 0.06), atol=2e-3)


def test_path_that_is_no_turn_and_advance_is_said_and_still_located() -> None:
    result = two_tap_result((0.9, 0.1, 0.06), PlanarPose().after_arc(0.25, 0.5), bare_context().description)
    assert "does not apply" in result.text
    assert result.target is not None and result.target.point_in_world is not None
    np.testing.assert_allclose(result.target.point_in_world, (0.9, 0.1, 0.06), atol=2e-3)


def test_typed_values_take_the_place_of_odometry() -> None:
    """The odometry slipped: it believes in half the way; the person measured."""
    description = mounted(bare_context(), forward=0.0, pitch_deg=0.0)
    from dataclasses import replace

    context = replace(bare_context(), description=description)
    second = seen((0.9, 0.0, 0.06), STEP.to_pose(), description)
    slipped = replace(second, world_from_base=PlanarStep(0.1, 0.1).to_pose())
    taps = {"first": seen((0.9, 0.0, 0.06), PlanarPose(), description), "second": slipped}
    progress = GuideProgress(TWO_TAP, 5, taps).with_value("theta_deg", 12.0).with_value("distance", 0.2)
    result = asyncio.run(result_of(context, GuideKind.TWO_TAP, progress, 3))
    assert "OQ1 = 0.900 m" in result.text


def test_no_advance_is_a_sentence() -> None:
    result = two_tap_result((0.9, 0.0, 0.06), PlanarStep(0.1, 0.0).to_pose(), bare_context().description)
    assert "no answer" in result.text and "advance d is 0" in result.text


def test_far_target_with_beta_below_theta_is_a_sentence() -> None:
    description = mounted(bare_context(), forward=0.0, pitch_deg=0.0)
    result = two_tap_result((0.9, 0.0, 0.06), STEP.to_pose(), description, {"theta": np.radians(30.0)})
    assert "no answer" in result.text and "infinity or behind" in result.text


def rotation_text(description: RobotDescription, near: ArrayLike, far: ArrayLike, turn: float) -> str:
    from dataclasses import replace

    context = replace(bare_context(), description=description)
    after = PlanarPose(heading=turn)
    taps = {
        "near": seen(near, PlanarPose(), description),
        "far": seen(far, PlanarPose(), description),
        "near_again": seen(near, after, description),
        "far_again": seen(far, after, description),
    }
    progress = GuideProgress(ROTATION_CENTRE, 5, taps)
    return asyncio.run(result_of(context, GuideKind.ROTATION_CENTRE, progress, 3)).text


def test_rotation_centre_check_finds_the_lever() -> None:
    text = rotation_text(bare_context().description, (0.6, 0.0, 0.0), (1.6, 0.0, 0.0), 0.17)
    lever = float(text.split("camera is ")[1].split(" ")[0])
    assert lever == pytest.approx(10.0, abs=1.5)
    assert "robot file says 10.0 cm" in text


def test_rotation_centre_check_without_a_turn_says_so() -> None:
    text = rotation_text(bare_context().description, (0.6, 0.0, 0.0), (1.6, 0.0, 0.0), 0.0)
    assert text.startswith("No answer") or "on the rotation axis" in text


def test_point_above_the_floor_cannot_serve_the_check() -> None:
    text = rotation_text(bare_context().description, (0.6, 0.0, 0.2), (1.6, 0.0, 0.0), 0.1)
    assert "near point must be where a thing meets the floor" in text
