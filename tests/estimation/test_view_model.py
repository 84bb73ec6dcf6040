"""The analytic derivative of the prediction against finite differences."""

from dataclasses import fields

import numpy as np
import pytest
from drive import observed, poses_along

from tapreach.estimation.map_solver import inverse_depth_information
from tapreach.estimation.motion_prior import MountNoise, camera_errors
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.planar_motion import PlanarStep

MOTIONS = {"exact": None, "odometry": OdometryNoise(), "poses": np.kron(np.eye(3), 1e-3 * np.eye(6))}


EVERYTHING = NuisancePriors(0.01, 0.02, 0.015, 0.004, 0.012, 0.011, 0.013)


def model_for(motion, mount_noise=None, nuisances=None, tap_bias_px=0.0, correlation=0.0):
    views = observed(poses_along([PlanarStep(0.1, 0.1), PlanarStep(0.2, 0.05)]), np.array([0.9, 0.1, 0.2]))
    errors = camera_errors(views, motion, mount_noise, nuisances, tap_bias_px)
    return view_model(views, errors, correlation)


@pytest.mark.parametrize("motion", list(MOTIONS))
@pytest.mark.parametrize("mount_noise", [None, MountNoise(0.005, 0.02)])
@pytest.mark.parametrize("rho", [1.1, 0.0, -0.3])
def test_derivative_agrees_with_finite_differences(motion, mount_noise, rho):
    check_derivative(model_for(MOTIONS[motion], mount_noise), rho)


@pytest.mark.parametrize("motion", list(MOTIONS))
def test_derivative_by_every_nuisance_agrees_with_finite_differences(motion):
    for each in fields(NuisancePriors):
        check_derivative(model_for(MOTIONS[motion], nuisances=NuisancePriors(**{each.name: 0.02})), 1.1)
    check_derivative(model_for(MOTIONS[motion], MountNoise(0.01, 0.02), EVERYTHING, 3.0, 0.4), 0.7)


def check_derivative(model, rho):
    x = np.stack([model.on_ray(np.array([rho]))[0]] * 2)
    x[:, 3:] = np.random.default_rng(5).normal(size=(2, model.unknowns - 3)) * 2.0
    views = model.linearised(x)
    jacobian = np.concatenate([views.by_target, views.by_errors], axis=2)
    for i in range(model.unknowns):
        step = 1e-6 * np.eye(model.unknowns)[i]
        ahead, back = model.linearised(x + step), model.linearised(x - step)
        expected = (ahead.residuals - back.residuals) / 2e-6
        np.testing.assert_allclose(jacobian[:, :, i], expected, rtol=1e-5, atol=2e-5)


def test_start_lies_on_the_ray_of_the_first_view_that_is_used():
    model = model_for(None).without(0)
    views = model.linearised(model.on_ray(np.array([0.7])))
    np.testing.assert_allclose(views.residuals[0, :4], 0.0, atol=1e-9)
    assert np.all(views.by_target[0, :2] == 0.0)


def test_costs_of_starts_agree_with_the_residuals():
    model = model_for(OdometryNoise())
    starts = model.on_ray(np.array([0.0, 0.5, 2.0]))
    expected = model.linearised(starts).costs
    np.testing.assert_allclose(model.costs_without_pose_errors(starts[:, :3]), expected, rtol=1e-9)


@pytest.mark.parametrize("motion", list(MOTIONS))
def test_information_on_the_target_is_the_schur_complement_of_all_the_unknowns(motion):
    model = model_for(MOTIONS[motion], MountNoise(0.005, 0.02), EVERYTHING, 2.0, 0.4)
    x = model.on_ray(np.array([1.1, 0.4]))
    x[:, 3:] = np.random.default_rng(1).normal(size=(2, model.unknowns - 3))
    views = model.linearised(x)
    for i in range(2):
        jacobian = np.concatenate([views.by_target[i], views.by_errors[i]], axis=1)
        information = jacobian.T @ jacobian
        information[3:, 3:] += np.eye(model.unknowns - 3)
        covariance = np.linalg.inv(information)
        expected = np.linalg.inv(covariance[:3, :3])
        np.testing.assert_allclose(views.on_target()[i], expected, rtol=1e-6, atol=1e-8 * expected.max())
        others = np.delete(np.delete(information, 2, axis=0), 2, axis=1)
        assert views.log_information_without_depth()[i] == pytest.approx(np.linalg.slogdet(others)[1])
        assert 1.0 / inverse_depth_information(views.on_target()[i]) == pytest.approx(covariance[2, 2])
