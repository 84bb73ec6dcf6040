"""Correlated taps: the whitening is exact, and the regions hold what they promise."""

import math

import numpy as np
import pytest
from drive import CAMERA, MOUNT, observed, poses_along
from scipy.stats import chi2

from tapreach.errors import InputError
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.tap_noise import TapNoise, whitening
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarStep


@pytest.mark.parametrize("correlation", [-0.5, 0.0, 0.4, 0.95])
@pytest.mark.parametrize("left_out", [[], [0], [2, 3], [1, 5]])
def test_whitening_is_the_inverse_root_of_the_correlation_of_the_views_used(correlation, left_out):
    is_used = np.ones(6, dtype=bool)
    is_used[left_out] = False
    every = np.arange(6)
    covariance = np.where(
        np.outer(is_used, is_used), correlation ** np.abs(every[:, None] - every), np.eye(6)
    )
    whitener = whitening(correlation, is_used)
    np.testing.assert_allclose(whitener @ covariance @ whitener.T, np.eye(6), atol=1e-12)
    np.testing.assert_allclose(whitener, np.linalg.inv(np.linalg.cholesky(covariance)), atol=1e-12)


@pytest.mark.parametrize("correlation", [-1.0, 1.0, math.nan])
def test_correlation_that_cannot_be_is_refused(correlation):
    with pytest.raises(InputError, match="correlation"):
        TapNoise(correlation)


def test_shared_bias_below_zero_is_refused():
    with pytest.raises(InputError, match="shared_bias_px"):
        TapNoise(shared_bias_px=-1.0)


def in_sequence(rng, views, correlation):
    errors = rng.normal(size=(views, 2))
    for i in range(1, views):
        errors[i] = correlation * errors[i - 1] + math.sqrt(1.0 - correlation**2) * errors[i]
    return errors


@pytest.mark.parametrize("views", [3, 10])
def test_region_of_correlated_taps_holds_the_truth_when_told_so(views):
    rng, target = np.random.default_rng(5), MOUNT.apply([0.05, 0.02, 1.0])
    poses = poses_along([PlanarStep(0.2 / (views - 1), 0.25 / (views - 1))] * (views - 1))
    clean = observed(poses, target, sigma=2.0)
    truth = np.array([0.05, 0.02, 1.0])
    held = {0.0: [], 0.5: []}
    for _ in range(300):
        errors = 2.0 * in_sequence(rng, views, 0.5)
        views_seen = [
            Observation(Pixel(v.pixel.u + du, v.pixel.v + dv), 2.0, CAMERA, v.world_from_base, MOUNT)
            for v, (du, dv) in zip(clean, errors.tolist(), strict=True)
        ]
        for told, results in held.items():
            found = estimate_point(
                views_seen, OdometryNoise.per_step(0.001), tap_noise=TapNoise(told), with_advice=False
            )
            error = np.array([*found.bearing, found.inverse_depth]) - truth
            distance = error @ np.linalg.solve(found.bearing_inverse_depth_cov, error)
            results.append(distance < chi2.ppf(0.95, 3))
    assert 0.91 < np.mean(held[0.5]) < 0.99
    assert np.mean(held[0.0]) < np.mean(held[0.5]) - 0.02
