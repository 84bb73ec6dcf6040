"""The pose errors eliminated: the same information and inverse by either way."""

import numpy as np
from drive import observed, poses_along

from tapreach.estimation.map_solver import solve
from tapreach.estimation.motion_prior import camera_errors
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.planar_motion import PlanarStep


def linearised():
    steps = [PlanarStep(0.1, 0.1), PlanarStep(0.2, 0.05), PlanarStep(-0.1, 0.2)]
    views = observed(poses_along(steps), np.array([0.9, 0.1, 0.2]))
    return solve(view_model(views, camera_errors(views, OdometryNoise()))).views


def test_inverse_of_the_factor_makes_the_inverse_of_the_covariance_of_the_residuals():
    views = linearised()
    expected = np.linalg.inv(np.eye(8) + views.by_errors[0] @ views.by_errors[0].T)
    np.testing.assert_allclose(views.unfactored.T @ views.unfactored, expected, rtol=1e-9, atol=1e-12)


def test_information_on_the_target_is_the_schur_complement_of_all_unknowns():
    views = linearised()
    target, errors = views.by_target[0], views.by_errors[0]
    across, on_errors = target.T @ errors, np.eye(errors.shape[1]) + errors.T @ errors
    expected = target.T @ target - across @ np.linalg.solve(on_errors, across.T)
    np.testing.assert_allclose(views.on_target()[0], expected, rtol=1e-7)
