"""Residuals of pairs of pixels: zero where they fit, and their derivatives against finite differences."""

import math

import numpy as np
import pytest
from drive import CAMERA, CENTRED_MOUNT, MOUNT

from tapreach.errors import InputError
from tapreach.estimation.background_solver import residuals_at
from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.epipolar import point_pairs, sampson, sampson_distances, turn_alone
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep

STEP = PlanarPose().after(PlanarStep(0.2, 0.25))


def seen_twice(mount, step=STEP, rng=None, sigma=0.0):
    rng = rng or np.random.default_rng(0)
    points = rng.uniform([0.8, -0.6, 0.0], [3.0, 1.2, 1.0], (40, 3))
    first = CAMERA.project(mount.inv().apply(points)).pixels
    second = CAMERA.project((step.to_rigid() * mount).inv().apply(points)).pixels
    noise = sigma * rng.normal(size=(2, 40, 2))
    return point_pairs(first + noise[0], second + noise[1], CAMERA)


def test_perfect_pairs_lie_on_their_lines_whatever_the_length_of_the_way():
    pose = camera_step(STEP, OdometryNoise(), MOUNT).first_from_second
    for length in (1e-3, 1.0, 1e3):
        distances = sampson_distances(
            seen_twice(MOUNT), pose.rotation.as_matrix(), length * np.asarray(pose.translation)
        )
        assert np.abs(distances).max() < 1e-9


def test_distance_is_a_pixel_of_noise_for_a_pixel_of_noise():
    pose = camera_step(STEP, OdometryNoise(), MOUNT).first_from_second
    rng = np.random.default_rng(1)
    pairs = [seen_twice(MOUNT, rng=rng, sigma=0.4) for _ in range(50)]
    distances = [sampson_distances(p, pose.rotation.as_matrix(), np.asarray(pose.translation)) for p in pairs]
    assert np.std(distances) == pytest.approx(0.4, rel=0.05)


def test_turn_alone_is_seen_without_residual():
    turn = PlanarPose(heading=0.2)
    pose = camera_step(turn, OdometryNoise(), CENTRED_MOUNT).first_from_second
    residuals, _ = turn_alone(seen_twice(CENTRED_MOUNT, turn), pose.rotation.as_matrix())
    assert np.abs(residuals).max() < 1e-9


@pytest.mark.parametrize("mount", [MOUNT, CENTRED_MOUNT], ids=["ahead", "centred"])
@pytest.mark.parametrize("step", [STEP, PlanarPose(heading=0.2)], ids=["drive", "turn"])
def test_derivative_equals_finite_differences(mount, step):
    pairs = seen_twice(mount, step, sigma=2.0)
    prior = camera_step(step, OdometryNoise(), mount, MountNoise(0.003, math.radians(0.5)))
    at = 2.0 * np.random.default_rng(3).normal(size=prior.by_normal.shape[1])
    _, jacobian = residuals_at(pairs, prior, at)
    for k, unit in enumerate(np.eye(len(at))):
        ahead, behind = (residuals_at(pairs, prior, at + h * unit)[0] for h in (1e-5, -1e-5))
        numeric = (ahead - behind) / 2e-5
        assert np.abs(numeric - jacobian[:, :, k]).max() < 1e-4 * max(1.0, np.abs(numeric).max())


def test_derivative_by_the_length_of_the_way_is_zero():
    pose = camera_step(STEP, OdometryNoise(), MOUNT).first_from_second
    rotation, translation = pose.rotation.as_matrix(), np.asarray(pose.translation)
    _, jacobian = sampson(seen_twice(MOUNT, sigma=1.0), rotation, translation)
    along = np.concatenate([rotation.T @ translation, np.zeros(3)])
    assert np.abs(jacobian @ along).max() < 1e-9 * np.abs(jacobian).max()


def test_arrays_that_do_not_match_are_refused():
    with pytest.raises(InputError, match="both must be"):
        point_pairs(np.zeros((3, 2)), np.zeros((4, 2)), CAMERA)
