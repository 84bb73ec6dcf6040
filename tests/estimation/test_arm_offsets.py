"""Zeros of the servos from seen claw places: the tip is right in the camera's frame, with an honest error."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.arm_offsets import ArmOffsets, NoOffsets, estimate_arm_offsets
from tapreach.estimation.claw_sight import ArmNoise, ClawPlace, ClawView, SightModel
from tapreach.estimation.motion_prior import MountNoise
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pose import camera_mount

ARM = ArmGeometry((0.02, -0.045, 0.121), 0.12, 0.12, 0.072)
CAMERA = Camera.from_fov(ImageSize(640, 480), math.radians(62.0))
MOUNT = camera_mount((0.10, 0.0, 0.15), pitch=math.radians(11.0))
NOISE = ArmNoise(math.radians(3.0), math.radians(0.2), 0.001, MountNoise(0.008, math.radians(1.5)))
TIPS = ((0.29, -0.045, 0.08), (0.30, -0.045, 0.05), (0.27, -0.02, 0.075), (0.27, -0.08, 0.06))
PLACES = ((0.025, 0.036, 0.011, 0.5), (0.025, -0.036, 0.011, -0.5), (0.025, 0.02, 0.011, 0.5))
SIGMA = 0.8


def joints_at(tip: tuple[float, float, float]) -> ArmJoints:
    joints = ARM.inverse(tip).joints
    assert joints is not None
    return joints


def seen(unknowns: FloatArray, rng: np.random.Generator) -> list[ClawView]:
    model, views = SightModel(ARM, MOUNT), []
    for tip in TIPS:
        sent = joints_at(tip)
        played = unknowns.copy()
        played[:3] += NOISE.play * rng.standard_normal(3)
        places = []
        for x, y, z, by_opening in PLACES:
            point = np.array([[x, y, z]])
            in_camera = model.in_camera(played, sent, point, np.array([by_opening]))
            pixel = CAMERA.project(in_camera).pixels[0] + SIGMA * rng.standard_normal(2)
            places.append(ClawPlace(point[0], by_opening, pixel, SIGMA))
        views.append(ClawView(sent, tuple(places)))
    return views


def estimated(views: list[ClawView]) -> ArmOffsets:
    found = estimate_arm_offsets(views, ARM, CAMERA, MOUNT, NOISE)
    assert isinstance(found, ArmOffsets)
    return found


def true_tip(unknowns: FloatArray, sent: ArmJoints) -> FloatArray:
    model = SightModel(ARM, MOUNT)
    return np.asarray(model.in_camera(unknowns, sent, np.zeros((1, 3)), np.zeros(1))[0])


def test_tip_is_right_in_the_cameras_frame_and_its_error_honest() -> None:
    rng = np.random.default_rng(11)
    errors, squared = [], []
    for _ in range(12):
        unknowns = NOISE.prior() * rng.standard_normal(10)
        offsets = estimated(seen(unknowns, rng))
        sent = joints_at((0.26, -0.05, 0.06))
        error = offsets.tip_in_camera(sent) - true_tip(unknowns, sent)
        covariance = offsets.tip_cov_in_camera(sent)
        errors.append(error)
        squared.append(float(error @ np.linalg.solve(covariance, error)))
    assert np.sqrt(np.mean(np.square(errors))) < 0.002
    # The covariance holds the play of a further move, which this comparison does not make.
    assert 0.5 < np.mean(squared) < 5.0


def test_place_that_is_none_of_the_claws_is_left_out() -> None:
    rng = np.random.default_rng(12)
    unknowns = NOISE.prior() * rng.standard_normal(10)
    views = seen(unknowns, rng)
    first = views[0].places[0]
    wrong = ClawPlace(first.in_gripper, first.by_opening, first.pixel + np.array([40.0, -25.0]), first.sigma)
    offsets = estimated([ClawView(views[0].sent, (wrong, *views[0].places[1:])), *views[1:]])
    assert offsets.left_out == 1
    sent = joints_at((0.28, -0.045, 0.05))
    assert np.linalg.norm(offsets.tip_in_camera(sent) - true_tip(unknowns, sent)) < 0.005


def test_places_without_agreement_give_no_offsets() -> None:
    rng = np.random.default_rng(13)
    views = [
        ClawView(
            view.sent,
            tuple(replace(place, pixel=place.pixel + rng.uniform(-40, 40, 2)) for place in view.places),
        )
        for view in seen(np.zeros(10), rng)
    ]
    found = estimate_arm_offsets(views, ARM, CAMERA, MOUNT, NOISE)
    assert isinstance(found, NoOffsets)
    assert "agree" in found.reason


def test_too_few_places_give_no_offsets() -> None:
    views = seen(np.zeros(10), np.random.default_rng(14))[:1]
    found = estimate_arm_offsets(views, ARM, CAMERA, MOUNT, NOISE)
    assert isinstance(found, NoOffsets)
    assert "3 places" in found.reason


def test_arm_behind_the_camera_gives_no_offsets() -> None:
    views = seen(np.zeros(10), np.random.default_rng(15))
    backwards = MOUNT * RigidTransform.from_exp_coords([0.0, math.pi, 0.0, 0.0, 0.0, 0.0])
    found = estimate_arm_offsets(views, ARM, CAMERA, backwards, NOISE)
    assert isinstance(found, NoOffsets)
    assert "cannot bring it" in found.reason


def test_derivatives_agree_with_differences() -> None:
    model, sent = SightModel(ARM, MOUNT), joints_at(TIPS[1])
    points, by_opening = np.array([[0.025, 0.03, 0.011], [0.0, 0.0, 0.0]]), np.array([0.5, 0.0])
    found = model.by_unknowns(np.zeros(10), sent, points, by_opening)
    for index in range(10):
        step = 1e-6 * np.eye(10)[index]
        more = model.in_camera(step, sent, points, by_opening)
        less = model.in_camera(-step, sent, points, by_opening)
        assert found[:, :, index] == pytest.approx((more - less) / 2e-6, abs=1e-5)


def test_noise_of_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="play"):
        ArmNoise(0.05, 0.0, 0.001, MountNoise(0.01, 0.02))
