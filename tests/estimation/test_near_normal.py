"""The short way to a range interval, against the posterior that it stands for and the whole profile."""

import numpy as np
import pytest
from drive import MOUNT, observed, poses_along
from scipy.integrate import quad
from scipy.stats import norm

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.map_solver import inverse_depth_information, solve
from tapreach.estimation.motion_prior import camera_errors
from tapreach.estimation.near_normal import UP_TO, NearNormalPosterior
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import Status
from tapreach.estimation.range_posterior import RangePrior, range_posterior
from tapreach.estimation.view_model import view_model
from tapreach.geometry.planar_motion import PlanarStep

ONE_PERCENT = OdometryNoise.per_step(0.01)


@pytest.mark.parametrize("relative_sd", [0.01, 0.1, 0.2, 0.25])
@pytest.mark.parametrize("farthest", [100.0, 3.0])
@pytest.mark.parametrize("falloff", [0.0, 0.5, 1.0])
def test_quantiles_are_those_of_normal_times_prior(relative_sd, farthest, falloff):
    rho, sd = 0.5, 0.5 * relative_sd
    posterior = NearNormalPosterior(rho, sd, 1.1, RangePrior(0.05, farthest, falloff))
    least = max(1.1 / farthest, rho - 4.0 * sd)

    def mass(start):
        def density(r):
            return norm.pdf(r, rho, sd) * r ** (falloff - 1.0)

        return quad(density, start, rho + 4.0 * sd, points=[rho], limit=200)[0]

    for probability, found in zip((0.025, 0.975), posterior.interval(0.025, 0.975), strict=True):
        assert mass(1.1 / found) / mass(least) == pytest.approx(probability, abs=0.005)


def test_answer_far_beyond_the_prior_drops_it_and_one_at_its_end_is_open():
    beyond = NearNormalPosterior(0.02, 0.001, 1.0, RangePrior(0.05, 20.0))
    assert not beyond.is_open_far
    low, high = beyond.interval(0.025, 0.975)
    assert low < 50.0 < high
    assert NearNormalPosterior(0.05, 0.01, 1.0, RangePrior(0.05, 20.0)).is_open_far


@pytest.mark.parametrize(("depth", "views"), [(1.5, 2), (3.0, 5), (4.0, 12)])
@pytest.mark.parametrize("falloff", [0.0, 1.0])
def test_ends_agree_with_those_of_the_whole_profile(depth, views, falloff):
    rng, prior = np.random.default_rng(3), RangePrior(falloff=falloff)
    poses = poses_along([PlanarStep(0.2 / (views - 1), 0.25 / (views - 1))] * (views - 1))
    compared = 0
    for _ in range(8):
        sightings = observed(poses, MOUNT.apply([0.05, 0.02, depth]), sigma=2.0, rng=rng)
        model = view_model(sightings, camera_errors(sightings, ONE_PERCENT))
        solution = solve(model)
        sd, rho = inverse_depth_information(solution.on_target) ** -0.5, solution.inverse_depth
        if sd > UP_TO * rho:
            continue
        slant = float(np.linalg.norm([*solution.x[:2], 1.0]))
        whole = range_posterior(model, solution, prior).interval(0.025, 0.975)
        short = NearNormalPosterior(rho, sd, slant, prior).interval(0.025, 0.975)
        np.testing.assert_allclose(slant / np.array(short), slant / np.array(whole), atol=0.25 * sd)
        compared += 1
    assert compared >= 3


def test_interval_holds_targets_drawn_from_the_prior_open_far_ends_too():
    rng, prior = np.random.default_rng(8), RangePrior(0.3, 8.0, falloff=0.0)
    poses = poses_along([PlanarStep(0.15, 0.08), PlanarStep(-0.05, 0.08)])
    held, held_open = [], []
    for _ in range(400):
        true_range = np.exp(rng.uniform(np.log(prior.nearest), np.log(prior.farthest)))
        direction = np.array([0.05, 0.02, 1.0])
        target = MOUNT.apply(true_range * direction / np.linalg.norm(direction))
        sightings = observed(poses, target, sigma=2.5, rng=rng)
        found = estimate_point(sightings, ONE_PERCENT, range_prior=prior, with_advice=False)
        low, high = found.range_interval_95
        held.append(low <= true_range <= (high or np.inf))
        if found.status is Status.RANGE_BOUNDED_BELOW:
            held_open.append(held[-1])
    assert 0.915 < np.mean(held) < 0.985
    assert len(held_open) > 60
    assert np.mean(held_open) > 0.87
