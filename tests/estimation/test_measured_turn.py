"""Odometry corrected by measured turns: against drives whose errors are known."""

import math

import numpy as np
import pytest
from drive import poses_along

from tapreach.errors import InputError
from tapreach.estimation.measured_turn import MeasuredTurn, with_measured_turns
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep

NOISE = OdometryNoise(turn_scale=0.03)
POSES = poses_along([PlanarStep(0.2, 0.0), PlanarStep(0.0, 0.25), PlanarStep(-0.1, 0.2)])
ROWS = [6 * i + j for i in range(1, 4) for j in (0, 1, 5)]


def planar_errors(said, true):
    return np.concatenate([_tangent(a.between(b)) for a, b in zip(said[1:], true[1:], strict=True)])


def _tangent(step):
    return [step.x, step.y, step.heading]


def test_without_a_measurement_it_is_the_odometry():
    corrected = with_measured_turns(POSES, NOISE, [MeasuredTurn(0, 1, 0.0, math.inf)])
    errors = pose_errors(POSES, NOISE)[1:].reshape(9, -1)
    assert list(corrected.poses) == POSES
    assert corrected.covariance[np.ix_(ROWS, ROWS)] == pytest.approx(errors @ errors.T)
    assert not np.any(corrected.covariance[:6]), "the first pose is exact"


def test_measured_turn_turns_what_was_driven_since():
    turned = with_measured_turns(POSES[:3], NOISE, [MeasuredTurn(0, 1, 0.01, 1e-6)]).poses
    assert turned[1].heading == pytest.approx(0.21, abs=1e-5)
    assert turned[2].heading == pytest.approx(0.21, abs=1e-5)
    assert math.atan2(turned[2].y, turned[2].x) == pytest.approx(0.21, abs=1e-3)
    assert math.hypot(turned[2].x, turned[2].y) == pytest.approx(0.25, abs=1e-4)


def test_errors_are_smaller_and_as_large_as_they_say():
    rng = np.random.default_rng(0)
    by_normal = pose_errors(POSES, NOISE)
    before, after, nees = [], [], []
    for _ in range(300):
        errors = by_normal @ rng.normal(size=by_normal.shape[2])
        true = [pose.compose(PlanarPose(*e)) for pose, e in zip(POSES, errors, strict=True)]
        turns = [MeasuredTurn(0, i, float(errors[i, 2] + 5e-4 * rng.normal()), 5e-4) for i in range(1, 4)]
        corrected = with_measured_turns(POSES, NOISE, turns)
        left = planar_errors(corrected.poses, true)
        before.append(planar_errors(POSES, true))
        after.append(left)
        covariance = corrected.covariance[np.ix_(ROWS, ROWS)] + 1e-14 * np.eye(9)
        nees.append(left @ np.linalg.solve(covariance, left) / 7.0)
    sideways, heading = [1, 4, 7], [2, 5, 8]
    assert np.std(np.array(after)[:, heading]) < 0.15 * np.std(np.array(before)[:, heading])
    assert np.std(np.array(after)[:, sideways]) < 0.8 * np.std(np.array(before)[:, sideways])
    # Seven degrees of freedom: a turn on the spot has no error in x and y.
    assert 0.88 < np.mean(nees) < 1.12


def test_wheels_taken_as_exact_stay_so():
    exact = OdometryNoise.per_step(0.0)
    corrected = with_measured_turns(POSES, exact, [MeasuredTurn(0, 1, 0.01, 0.0)])
    assert list(corrected.poses) == POSES


@pytest.mark.parametrize("pair", [(0, 4), (-1, 2)])
def test_turn_between_poses_that_are_not_there_is_refused(pair):
    with pytest.raises(InputError, match="there are 4 poses"):
        with_measured_turns(POSES, NOISE, [MeasuredTurn(*pair, 0.0, 0.1)])


@pytest.mark.parametrize(("excess", "sd"), [(math.nan, 0.1), (0.1, -1.0), (0.1, math.nan)])
def test_numbers_that_are_none_are_refused(excess, sd):
    with pytest.raises(InputError):
        MeasuredTurn(0, 1, excess, sd)
