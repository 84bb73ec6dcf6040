"""The analytic derivative of the prediction against finite differences."""

import numpy as np
import pytest
from drive import MOUNT, observed, poses_along

from tapreach.estimation.map_solver import inverse_depth_information, target_information
from tapreach.estimation.motion_prior import MountNoise, camera_errors
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.planar_motion import PlanarStep

MOTIONS = {"exact": None, "odometry": OdometryNoise(), "poses": np.kron(np.eye(3), 1e-3 * np.eye(6))}


def model_for(motion, mount_noise=None):
    views = observed(poses_along([PlanarStep(0.1, 0.1), PlanarStep(0.2, 0.05)]), np.array([0.9, 0.1, 0.2]))
    return view_model(views, camera_errors(views, motion, mount_noise))


@pytest.mark.parametrize("motion", list(MOTIONS))
@pytest.mark.parametrize("mount_noise", [None, MountNoise(0.005, 0.02)])
@pytest.mark.parametrize("rho", [1.1, 0.0, -0.3])
def test_derivative_agrees_with_finite_differences(motion, mount_noise, rho):
    model = model_for(MOTIONS[motion], mount_noise)
    x = model.at(rho)
    x[3:] = np.random.default_rng(5).normal(size=model.unknowns - 3) * 2.0
    _, jacobian = model.whitened(model.predict(x))
    for i in range(model.unknowns):
        step = 1e-6 * np.eye(model.unknowns)[i]
        ahead, _ = model.whitened(model.predict(x + step))
        back, _ = model.whitened(model.predict(x - step))
        np.testing.assert_allclose(jacobian[:, :, i], (ahead - back) / 2e-6, rtol=1e-5, atol=2e-5)


def test_start_lies_on_the_ray_of_the_first_view_that_is_used():
    model = model_for(None).without(0)
    residuals, jacobian = model.whitened(model.predict(model.at(0.7)))
    np.testing.assert_allclose(residuals[:2], 0.0, atol=1e-9)
    assert np.all(jacobian[0] == 0.0)


def test_costs_of_starts_agree_with_the_residuals():
    model = model_for(OdometryNoise())
    starts = np.stack([model.at(rho) for rho in (0.0, 0.5, 2.0)])
    expected = [np.sum(model.whitened(model.predict(x))[0] ** 2) for x in starts]
    np.testing.assert_allclose(model.costs_without_pose_errors(starts[:, :3]), expected, rtol=1e-9)


def test_schur_complement_is_the_inverse_of_the_marginal_covariance():
    rng = np.random.default_rng(0)
    root = rng.normal(size=(7, 9))
    information = root @ root.T
    covariance = np.linalg.inv(information)
    on_target = target_information(information)
    np.testing.assert_allclose(on_target, np.linalg.inv(covariance[:3, :3]), rtol=1e-9)
    assert 1.0 / inverse_depth_information(on_target) == pytest.approx(covariance[2, 2])


def test_mount_error_is_the_same_motion_for_all_cameras():
    views = observed(poses_along([PlanarStep(0.1, 0.1)]), np.array([0.9, 0.1, 0.2]), MOUNT)
    errors = camera_errors(views, OdometryNoise(), MountNoise(0.005, 0.02))
    columns = errors.by_mount.any(axis=0)
    np.testing.assert_array_equal(errors.by_normal[0][:, columns], errors.by_normal[1][:, columns])
