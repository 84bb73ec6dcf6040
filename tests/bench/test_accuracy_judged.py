"""Chance is taken away from the figures of a setting, and nothing else is."""

import math

import numpy as np
import pytest

from tapreach.bench.accuracy_judged import Judged, controlled, judged_cell
from tapreach.bench.accuracy_linear import linear
from tapreach.bench.accuracy_outcomes import Outcomes
from tapreach.bench.accuracy_trials import Cell, draw_trials, well_defined_drive
from tapreach.bench.figure import within
from tapreach.estimation.bound import position_bound

CELLS = [Cell(1.0, 2, 1.0, 0.01), Cell(2.5, 5, 3.0, 0.03), Cell(0.5, 20, 1.0, 0.03)]


def experiment_and_trials(cell, count, seed=1):
    trials = draw_trials(cell, count, np.random.default_rng(seed))
    sigmas = np.full(cell.views, cell.pixel_sigma)
    return linear(well_defined_drive(cell), trials.targets[0], sigmas, cell.odometry), trials


def answered(errors, information, count=None):
    nees = np.sum((errors @ information) * errors, axis=1)
    nothing = np.full(len(errors), np.nan)
    nees[len(errors) if count is None else count :] = np.nan
    return Outcomes(errors, nees, nothing, nothing, nothing, np.zeros((len(errors), 2), bool))


@pytest.mark.parametrize("cell", CELLS, ids=str)
def test_bound_of_the_scene_is_that_of_the_estimator(cell):
    experiment, trials = experiment_and_trials(cell, 1)
    observations = next(trials.sightings())
    a, b, rho = trials.targets[0]
    point = observations[0].world_from_camera.apply(np.array([a, b, 1.0]) / rho)
    bound = position_bound(observations, point, cell.noise)
    np.testing.assert_allclose(np.linalg.inv(experiment.information), bound.covariance, rtol=1e-5)


@pytest.mark.parametrize("cell", CELLS, ids=str)
def test_linear_errors_have_the_bound_as_their_covariance(cell):
    experiment, trials = experiment_and_trials(cell, 20_000)
    errors = experiment.errors_of(trials.chance)
    sds = np.sqrt(np.diag(np.linalg.inv(experiment.information)))
    expected = np.linalg.inv(experiment.information) / np.outer(sds, sds)
    np.testing.assert_allclose(np.cov((errors / sds).T), expected, atol=0.04)


def test_many_drives_at_once_give_what_each_gives():
    cell = CELLS[1]
    experiment, trials = experiment_and_trials(cell, 1)
    one = well_defined_drive(cell)
    several = type(one)(np.array([one.turns, 0.5 * one.turns]), np.array([one.advances, one.advances]))
    sigmas = np.full(cell.views, cell.pixel_sigma)
    found = linear(several, trials.targets[0], sigmas, cell.odometry).inverse_depth_sd
    assert found[0] == pytest.approx(experiment.inverse_depth_sd, rel=1e-12)
    assert found[1] != pytest.approx(experiment.inverse_depth_sd, rel=1e-3)


def test_view_of_infinite_sigma_says_nothing():
    cell = CELLS[1]
    drive = well_defined_drive(cell)
    target = np.array([-0.05, 0.05, 0.4])
    without = linear(drive, target, np.array([3.0, 3.0, 3.0, 3.0, np.inf]), 0.03).inverse_depth_sd
    shorter = type(drive)(drive.turns[:-1], drive.advances[:-1])
    assert without == pytest.approx(linear(shorter, target, np.full(4, 3.0), 0.03).inverse_depth_sd, rel=1e-9)


def test_estimate_that_is_the_linear_one_is_judged_without_chance():
    experiment, trials = experiment_and_trials(CELLS[0], 300)
    errors = experiment.errors_of(trials.chance)
    figures = judged_cell(answered(errors, experiment.information), errors, experiment)
    for judged, expected in zip(figures.all, (1.0, 0.95, 1.0), strict=True):
        assert judged.value == pytest.approx(expected, abs=1e-12)
        assert judged.is_told and not judged.is_broken


@pytest.mark.parametrize("stretch", [0.9, 1.1])
def test_estimate_off_the_bound_is_judged_as_such(stretch):
    experiment, trials = experiment_and_trials(CELLS[0], 600)
    errors = experiment.errors_of(trials.chance)
    figures = judged_cell(answered(stretch * errors, experiment.information), errors, experiment)
    assert figures.error.value == pytest.approx(stretch, abs=0.03)
    assert figures.consistency.value == pytest.approx(stretch**2, abs=0.03)
    assert figures.consistency.is_broken
    assert (figures.error.is_broken, figures.region.value > 0.95) == (stretch > 1.0, stretch < 1.0)


def test_unanswered_trials_leave_nothing_to_subtract():
    experiment, trials = experiment_and_trials(CELLS[0], 400)
    errors = experiment.errors_of(trials.chance)
    figures = judged_cell(answered(errors, experiment.information, 300), errors, experiment)
    plain = np.mean((errors[:300, 2] / experiment.inverse_depth_sd) ** 2)
    assert figures.error.value == pytest.approx(math.sqrt(plain))


def test_controlled_mean_is_right_and_surer_than_the_plain_one():
    random = np.random.default_rng(3)
    controls = random.normal(size=(400, 500))
    values = 2.0 + controls + 0.1 * random.normal(size=controls.shape)
    found = np.array([controlled(v, c, 0.0) for v, c in zip(values, controls, strict=True)])
    assert found[:, 0].mean() == pytest.approx(2.0, abs=0.001)
    assert found[:, 0].std() == pytest.approx(0.1 / math.sqrt(500), rel=0.15)
    assert found[:, 1].mean() == pytest.approx(0.1 / math.sqrt(500), rel=0.05)


def test_value_near_a_limit_is_not_told_and_not_broken_by_chance():
    wanted = within(0.94, 0.96)
    assert Judged(0.95, 0.003, wanted).is_told
    assert not Judged(0.958, 0.003, wanted).is_told
    assert Judged(0.93, 0.003, wanted).is_broken
    assert not Judged(0.935, 0.003, wanted).is_broken
