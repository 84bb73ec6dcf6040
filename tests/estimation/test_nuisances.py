"""Nuisances with priors: each does what it says, and the region covers what it allows."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from drive import CAMERA, MOUNT, observed, poses_along
from scipy.stats import chi2

from tapreach.errors import InputError
from tapreach.estimation.bound import position_bound
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import MountNoise, camera_errors
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.tap_noise import TapNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.camera import Camera
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.geometry.pose import camera_mount

TARGET = np.array([1.1, 0.06, 0.1])
STEPS = [PlanarStep(0.15, 0.08), PlanarStep(-0.05, 0.1), PlanarStep(0.05, 0.1)]
LEVER, PITCH, YAW, ROLL = (0.10, 0.01, 0.15), math.radians(10.0), 0.02, -0.01
ONE_PERCENT = OdometryNoise.per_step(0.01)
SMALL = 1e-4


def zoomed(factor):
    return Camera(CAMERA.size, CAMERA.fx * factor, CAMERA.fy * factor, CAMERA.cx, CAMERA.cy)


def stretched(turn=1.0, advance=1.0):
    return poses_along([PlanarStep(turn * step.turn, advance * step.advance) for step in STEPS])


def mount_with(**changes):
    given = {"position": LEVER, "pitch": PITCH, "yaw": YAW, "roll": ROLL} | changes
    return camera_mount(given["position"], given["pitch"], given["yaw"], given["roll"])


WORLDS = {
    "focal_scale": {"camera": zoomed(1.0 + SMALL)},
    "turn_scale": {"poses": stretched(turn=1.0 + SMALL)},
    "distance_scale": {"poses": stretched(advance=1.0 + SMALL)},
    "lever": {"mount": mount_with(position=(LEVER[0] + SMALL, *LEVER[1:]))},
    "yaw": {"mount": mount_with(yaw=YAW + SMALL)},
    "pitch": {"mount": mount_with(pitch=PITCH + SMALL)},
    "roll": {"mount": mount_with(roll=ROLL + SMALL)},
}


@pytest.mark.parametrize("name", [each.name for each in fields(NuisancePriors)])
def test_pixels_of_a_world_that_is_off_are_explained_by_one_sigma(name):
    truth = {"poses": poses_along(STEPS)} | WORLDS[name]
    mount, camera = truth.get("mount", MOUNT), truth.get("camera", CAMERA)
    seen = observed(truth["poses"], TARGET, mount, camera)
    told = [
        replace(view, camera=CAMERA, base_from_camera=MOUNT, world_from_base=pose.to_rigid())
        for view, pose in zip(seen, poses_along(STEPS), strict=True)
    ]
    model = view_model(told, camera_errors(told, None, nuisances=NuisancePriors(**{name: SMALL})))
    x = np.zeros((2, model.unknowns))
    x[:, :3] = point_in_first(seen[0])
    x[1, 3] = 1.0
    unexplained, explained = np.abs(model.linearised(x).residuals).max(axis=1)
    assert explained < 3e-4 < 1e-2 < 10.0 * unexplained


def point_in_first(view):
    x, y, z = view.world_from_camera.inv().apply(TARGET)
    return x / z, y / z, 1.0 / z


@pytest.mark.parametrize("name", [each.name for each in fields(NuisancePriors)])
def test_every_nuisance_widens_the_region_and_none_changes_nothing(name):
    views = observed(poses_along(STEPS), TARGET)
    sure = estimate_point(views, ONE_PERCENT, with_advice=False)
    same = estimate_point(views, ONE_PERCENT, nuisances=NuisancePriors(), with_advice=False)
    unsure = estimate_point(views, ONE_PERCENT, nuisances=NuisancePriors(**{name: 0.05}), with_advice=False)
    np.testing.assert_array_equal(sure.bearing_inverse_depth_cov, same.bearing_inverse_depth_cov)
    assert np.trace(unsure.point_cov_in_base) > 1.002 * np.trace(sure.point_cov_in_base)
    assert np.all(np.linalg.eigvalsh(unsure.point_cov_in_world - sure.point_cov_in_world) > -1e-12)


def test_the_bound_knows_of_nuisances_and_of_how_taps_hang_together():
    views = observed(poses_along(STEPS), TARGET)
    nuisances, taps = NuisancePriors(focal_scale=0.02, yaw=0.01), TapNoise(0.4, 2.0)
    bound = position_bound(views, TARGET, ONE_PERCENT, MountNoise(0.002, 0.01), nuisances, taps)
    found = estimate_point(
        views,
        ONE_PERCENT,
        mount_noise=MountNoise(0.002, 0.01),
        nuisances=nuisances,
        tap_noise=taps,
        with_advice=False,
    )
    np.testing.assert_allclose(found.bearing_inverse_depth_cov, bound.covariance, rtol=1e-6)


def test_wheel_scales_apply_whatever_else_is_known_of_the_poses():
    views = observed(poses_along(STEPS), TARGET)
    scales = NuisancePriors(turn_scale=0.02, distance_scale=0.03)
    in_noise = replace(ONE_PERCENT, turn_scale=0.02, advance_scale=0.03)
    expected = position_bound(views, TARGET, in_noise)
    assert position_bound(views, TARGET, ONE_PERCENT, nuisances=scales).relative_sd == pytest.approx(
        expected.relative_sd
    )
    exact = OdometryNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.03, 0.02)
    assert position_bound(views, TARGET, None, nuisances=scales).relative_sd == pytest.approx(
        position_bound(views, TARGET, exact).relative_sd
    )


@pytest.mark.parametrize("name", [each.name for each in fields(NuisancePriors)])
def test_a_nuisance_below_zero_is_refused(name):
    with pytest.raises(InputError, match=name):
        NuisancePriors(**{name: -0.1})


def test_regions_hold_when_focal_length_yaw_and_taps_are_off_as_was_said():
    rng = np.random.default_rng(11)
    nuisances, taps = NuisancePriors(focal_scale=0.01, yaw=0.01, turn_scale=0.03), TapNoise(0.0, 3.0)
    distances = []
    for _ in range(300):
        mount = mount_with(yaw=YAW + 0.01 * rng.normal())
        poses = stretched(turn=1.0 + 0.03 * rng.normal())
        views = observed(
            poses, TARGET, mount, zoomed(1.0 + 0.01 * rng.normal()), said=poses_along(STEPS), rng=rng
        )
        bias = 3.0 * rng.normal(size=2)
        told = [
            replace(
                view,
                pixel=replace(view.pixel, u=view.pixel.u + bias[0], v=view.pixel.v + bias[1]),
                camera=CAMERA,
                base_from_camera=MOUNT,
            )
            for view in views
        ]
        found = estimate_point(told, None, nuisances=nuisances, tap_noise=taps, with_advice=False)
        error = np.array([*found.bearing, found.inverse_depth]) - point_in_first(views[0])
        distances.append(error @ np.linalg.solve(found.bearing_inverse_depth_cov, error))
    assert 0.90 < np.mean(np.array(distances) < chi2.ppf(0.95, 3)) < 0.99
