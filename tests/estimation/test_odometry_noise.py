"""The noise model against simulated drives, and its independence of how a way is cut into steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep

ROOT_NOISE = OdometryNoise(0.02, 0.03, 0.025, 0.01, 0.0, 0.0, 0.015, 0.02)


def joint_covariance(poses, noise, index):
    errors = pose_errors(poses, noise)[index]
    return errors @ errors.T


def test_step_covariance_agrees_with_simulated_turn_and_advance():
    noise = OdometryNoise(0.01, 0.02, 0.0, 0.02, 0.03, 0.04, 0.0, 0.0)
    step = PlanarStep(0.4, 0.6)
    rng = np.random.default_rng(4)
    nominal, ends = step.to_pose(), []
    for _ in range(20_000):
        turn = 0.4 + rng.normal() * math.hypot(0.02 * math.sqrt(0.4), 0.04 * 0.4)
        advance = 0.6 + rng.normal() * math.hypot(0.01 * math.sqrt(0.6), 0.03 * 0.6)
        slip = rng.normal() * 0.02 * math.sqrt(0.6)
        end = PlanarPose(heading=turn).compose(PlanarPose(advance, slip, 0.0))
        error = nominal.between(end)
        ends.append((error.x, error.y, error.heading))
    np.testing.assert_allclose(noise.step_covariance(nominal), np.cov(np.array(ends).T), atol=1.2e-5)


# Of shorter ways the rounding of the coordinates decides where they lead.
LONG_ENOUGH = st.floats(-1.0, 1.0).filter(lambda distance: abs(distance) > 1e-4)


@given(st.floats(-0.8, 0.8), LONG_ENOUGH, st.integers(2, 6))
def test_covariance_does_not_depend_on_how_a_straight_way_is_cut(heading, distance, pieces):
    start = PlanarPose(0.3, -0.2, heading)
    whole = [start, start.after_arc(distance, 0.0)]
    cut = [start.after_arc(distance * i / pieces, 0.0) for i in range(pieces + 1)]
    np.testing.assert_allclose(
        joint_covariance(cut, ROOT_NOISE, -1), joint_covariance(whole, ROOT_NOISE, -1), atol=1e-12
    )


@given(st.floats(-2.0, 2.0), st.integers(2, 6))
def test_covariance_does_not_depend_on_how_a_turn_is_cut(turn, pieces):
    whole = [PlanarPose(), PlanarPose(heading=turn)]
    cut = [PlanarPose(heading=turn * i / pieces) for i in range(pieces + 1)]
    np.testing.assert_allclose(
        joint_covariance(cut, ROOT_NOISE, -1), joint_covariance(whole, ROOT_NOISE, -1), atol=1e-12
    )


@given(st.floats(-5.0, 5.0), st.floats(-3.0, 3.0))
def test_errors_do_not_depend_on_where_the_world_begins(x, heading):
    poses = [PlanarPose(), PlanarPose(0.2, 0.05, 0.3), PlanarPose(0.5, 0.2, 0.1)]
    moved = [PlanarPose(x, 1.0, heading).compose(pose) for pose in poses]
    np.testing.assert_allclose(
        joint_covariance(moved, ROOT_NOISE, -1), joint_covariance(poses, ROOT_NOISE, -1), atol=1e-9
    )


def test_early_heading_error_swings_the_far_end():
    noise = OdometryNoise(0, 0.05, 0, 0, 0, 0, 0, 0)
    turned = PlanarPose().after(PlanarStep(0.4, 0.0))
    covariance = joint_covariance([PlanarPose(), turned, turned.after_arc(2.0, 0.0)], noise, -1)
    heading_sd = 0.05 * math.sqrt(0.4)
    assert math.sqrt(covariance[2, 2]) == pytest.approx(heading_sd)
    assert math.sqrt(covariance[1, 1]) == pytest.approx(2.0 * heading_sd)


def test_driving_backwards_is_an_advance_and_no_turn():
    noise = OdometryNoise(0, 0, 0, 0, 0, 0.1, 0, 0)
    assert np.all(noise.step_covariance(PlanarPose(-0.5, 0.0, 0.0)) == 0.0)


@pytest.mark.parametrize("bad", [-0.01, math.nan, math.inf])
def test_noise_that_cannot_be_is_refused_by_name(bad):
    with pytest.raises(InputError, match="slip_per_sqrt_m"):
        OdometryNoise(slip_per_sqrt_m=bad)


def test_errors_of_one_step_are_those_of_the_same_step_among_many():
    steps = np.random.default_rng(5).uniform(-1.0, 1.0, size=(200, 3)) * [0.5, 0.5, 4.0]
    steps[:5] = [[0, 0, 0], [0, 0, 0.3], [0.4, 0, 0], [-0.4, 0, 0], [-0.4, 0, 0.2]]
    for noise in (OdometryNoise(), OdometryNoise.per_step(0.02)):
        among_many = noise.step_errors(steps)
        for step, expected in zip(steps, among_many, strict=True):
            np.testing.assert_allclose(noise.step_errors(step[None])[0], expected, rtol=1e-9, atol=1e-14)


def test_creep_moves_a_base_that_turns_and_leaves_one_that_only_drives():
    noise = OdometryNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, creep_per_rad=0.004)
    turned = noise.step_covariance(PlanarPose(0.0, 0.0, 0.5))
    assert np.allclose(turned, np.diag([0.002**2, 0.002**2, 0.0]))
    assert np.allclose(noise.step_covariance(PlanarPose(0.4, 0.0, 0.0)), 0.0)
