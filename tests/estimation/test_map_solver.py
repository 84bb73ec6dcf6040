"""One plain descent gives what many damped ones do, and slips are found with the false alarms said."""

import math

import numpy as np
import pytest
from drive import CAMERA, MOUNT, observed, poses_along

from tapreach.estimation import map_solver
from tapreach.estimation.gauss_newton_plain import settled
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.map_solver import covariance_of, solve
from tapreach.estimation.motion_prior import camera_errors
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.outlier import _gains_and_limits
from tapreach.estimation.tap_noise import TapNoise
from tapreach.estimation.view_model import view_model
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarStep


def noisy_model(rng, views=5, depth=None, sigma=2.0, correlation=0.0):
    each = 0.35 / (views - 1)
    steps = [
        PlanarStep(rng.uniform(-0.5, 0.5) * each, rng.uniform(0.3, 1.0) * each) for _ in range(views - 1)
    ]
    target = MOUNT.apply([0.05, 0.02, depth or rng.uniform(0.9, 5.0)])
    sightings = observed(poses_along(steps), target, sigma=sigma, rng=rng)
    return view_model(sightings, camera_errors(sightings, OdometryNoise()), correlation)


@pytest.mark.parametrize("correlation", [0.0, 0.4])
def test_one_descent_ends_where_the_best_of_many_does(monkeypatch, correlation):
    rng, alike = np.random.default_rng(1), 0
    for views in (2, 3, 5, 12):
        for _ in range(10):
            model = noisy_model(rng, views, correlation=correlation)
            quick = map_solver._at_crossing(model)
            if quick is None:
                continue
            with monkeypatch.context() as patch:
                patch.setattr(map_solver, "_at_crossing", lambda _: None)
                thorough = solve(model)
            assert quick.cost == pytest.approx(thorough.cost, abs=1e-5)
            sds = np.sqrt(np.diag(covariance_of(thorough.on_target)))
            assert np.all(np.abs(quick.x[:3] - thorough.x[:3]) < 5e-3 * sds)
            alike += 1
    assert alike >= 20


def test_descent_that_would_raise_the_cost_or_starts_behind_says_so():
    model = noisy_model(np.random.default_rng(2), 3, depth=1.0)
    behind = np.zeros(model.unknowns)
    behind[2] = 40.0
    assert settled(model, behind) is None


def test_lines_of_sight_of_exact_sightings_meet_in_the_target():
    model = noisy_model(np.random.default_rng(4), 4, depth=1.7, sigma=1.0)
    clean = noisy_model(np.random.default_rng(4), 4, depth=1.7, sigma=1e-9)
    np.testing.assert_allclose(clean.triangulated()[:3], [0.05 / 1.7, 0.02 / 1.7, 1.0 / 1.7], rtol=1e-6)
    assert np.all(model.triangulated()[3:] == 0.0)


def test_false_alarms_are_split_and_add_up_to_one_percent():
    for correlation in (0.0, 0.4):
        model = noisy_model(np.random.default_rng(5), 6, depth=1.2, correlation=correlation)
        _, limits = _gains_and_limits(model, solve(model))
        shares = np.exp(-0.5 * limits)
        assert shares.sum() == pytest.approx(0.01)
        assert shares.max() > 1.2 * shares.min()


@pytest.mark.parametrize("correlation", [0.0, 0.4])
def test_predicted_gain_of_a_small_slip_is_the_fall_of_the_cost(correlation):
    model = noisy_model(np.random.default_rng(6), 6, depth=1.0, sigma=0.5, correlation=correlation)
    solution = solve(model)
    gains, _ = _gains_and_limits(model, solution)
    for view, gain in enumerate(gains):
        assert solution.cost - solve(model.without(view)).cost == pytest.approx(gain, rel=0.02, abs=0.02)


@pytest.mark.parametrize(("correlation", "most"), [(0.0, 0.02), (0.4, 0.025)])
def test_taps_without_a_slip_are_seldom_left_out(correlation, most):
    rng, alarms, runs = np.random.default_rng(9), 0, 500
    poses = poses_along([PlanarStep(0.06, 0.06)] * 4)
    clean = observed(poses, MOUNT.apply([0.05, 0.02, 1.0]), sigma=3.0)
    for _ in range(runs):
        errors = 3.0 * rng.normal(size=(5, 2))
        for i in range(1, 5):
            errors[i] = correlation * errors[i - 1] + math.sqrt(1.0 - correlation**2) * errors[i]
        seen = [
            Observation(Pixel(v.pixel.u + du, v.pixel.v + dv), 3.0, CAMERA, v.world_from_base, MOUNT)
            for v, (du, dv) in zip(clean, errors.tolist(), strict=True)
        ]
        found = estimate_point(
            seen, OdometryNoise.per_step(0.001), tap_noise=TapNoise(correlation), with_advice=False
        )
        alarms += bool(found.rejected_views)
    assert alarms / runs < most
