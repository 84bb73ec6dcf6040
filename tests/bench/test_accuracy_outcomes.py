"""Scoring: coverage, consistency and interval figures from answers made by hand."""

import math

import numpy as np
import pytest

from tapreach.bench.accuracy_intervals import interval_figures
from tapreach.bench.accuracy_outcomes import Outcomes, joined
from tapreach.bench.accuracy_slips import SLIP_PX, slip
from tapreach.bench.accuracy_trials import Cell, draw_trials


def outcomes(count=20_000, stretch=1.0, seed=2):
    random = np.random.default_rng(seed)
    errors = random.normal(size=(count, 3))
    nees = np.sum((errors * stretch) ** 2, axis=1)
    error, sd = random.normal(size=count), random.uniform(0.005, 0.02, size=count)
    near, far = 2.0 + sd * (error - 1.96), 2.0 + sd * (error + 1.96)
    return Outcomes(errors, nees, near, far, np.full(count, 2.0), np.zeros((count, 5), bool))


def test_honest_covariance_scores_as_honest():
    honest = outcomes()
    assert honest.region_coverage() == pytest.approx(0.95, abs=0.006)
    assert honest.consistency() == pytest.approx(1.0, abs=0.02)
    assert honest.error_over(1.0) == pytest.approx(1.0, abs=0.02)
    assert honest.interval_coverage() == pytest.approx(0.95, abs=0.006)


def test_too_small_a_covariance_scores_as_such():
    bold = outcomes(stretch=1.5)
    assert bold.region_coverage() < 0.85
    assert bold.consistency() == pytest.approx(2.25, abs=0.06)


def test_missing_answers_are_left_out_of_every_mean():
    some = outcomes(10)
    some.errors[3:], some.nees[3:], some.nearest[3:], some.farthest[3:] = (math.nan,) * 4
    assert some.is_answered.sum() == some.has_interval.sum() == 3
    assert math.isfinite(some.error_over(1.0)) and math.isfinite(some.region_coverage())
    some.nees[:] = math.nan
    assert math.isnan(some.region_coverage())


def test_interval_figures_show_a_group_that_is_wrong():
    sure, wide = outcomes(1000), outcomes(3000, seed=3)
    sure.nearest[:], sure.farthest[:] = 2.1, 2.1001  # the surest quarter, all of it wrong
    figures = interval_figures(joined([sure, wide]))
    everything, closed, is_open, *quarters = (figure.holds for figure in figures)
    assert (everything, closed, is_open) == (False, False, None)
    assert quarters == [False, True, True, True]


def test_open_interval_holds_all_that_is_farther():
    open_far = outcomes(100)
    open_far.farthest[:] = math.inf
    open_far.nearest[:] = np.where(np.arange(100) < 95, 1.0, 3.0)
    everything, closed, is_open = interval_figures(open_far)
    assert everything.value == is_open.value == pytest.approx(95.0)
    assert closed.value is None


def test_slip_moves_one_view_by_its_length():
    trials = draw_trials(Cell(1.0, 5, 3.0, 0.01), 50, np.random.default_rng(1))
    views = np.arange(50) % 5
    moved = slip(trials, views, np.linspace(0.0, 6.0, 50)).pixels - trials.pixels
    lengths = np.linalg.norm(moved, axis=2)
    np.testing.assert_allclose(lengths[np.arange(50), views], SLIP_PX)
    assert np.count_nonzero(lengths) == 50
