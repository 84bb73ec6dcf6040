"""The trials of the accuracy bench: errors of the size they claim, and no truth in what is handed on."""

import dataclasses

import numpy as np
import pytest

from tapreach.bench.accuracy_plan import Part, generator
from tapreach.bench.accuracy_taps import (
    CORRELATION,
    correlated,
    correlated_and_heavy_tailed,
    heavy_tailed,
    normal,
)
from tapreach.bench.accuracy_trials import Cell, all_cells, draw_trials, well_defined_drive
from tapreach.bench.accuracy_wandering import SINGULAR, draw_motions, wandering
from tapreach.errors import InputError
from tapreach.estimation.bound import position_bound
from tapreach.estimation.odometry_noise import OdometryNoise

NEAR = Cell(1.0, 5, 1.0, 0.01)


def random(task=0):
    return generator(11, Part.CELLS, task)


@pytest.mark.parametrize("cell", all_cells(), ids=str)
def test_target_stays_in_the_picture_in_every_setting(cell):
    assert draw_trials(cell, 500, random()).pixels.shape == (500, cell.views, 2)


def test_target_that_would_leave_the_picture_is_refused():
    with pytest.raises(InputError, match="leaves the picture"):
        draw_trials(Cell(0.12, 2, 1.0, 0.01), 10, random())


def test_truth_differs_from_what_the_wheels_say_by_the_odometry_error():
    still = Cell(1.0, 2, 1e-9, 0.03)
    exact = draw_trials(Cell(1.0, 2, 1e-9, 0.0), 1, random()).pixels[0, 1]
    moved = draw_trials(still, 4000, random()).pixels[:, 1] - exact
    turn_px = 600.0 * 0.03 * well_defined_drive(still).turns[0]
    assert turn_px * 0.9 < moved[:, 0].std() < turn_px * 2.0  # the lever and the advance add to the turn
    assert draw_trials(still, 2, random()).said.std(axis=0).max() == 0.0


def test_observations_hold_what_was_said_and_seen_and_nothing_else():
    trials = draw_trials(NEAR, 3, random())
    other_truth = dataclasses.replace(trials, targets=np.full_like(trials.targets, 0.123))
    for views, others in zip(trials.sightings(), other_truth.sightings(), strict=True):
        for view, other in zip(views, others, strict=True):
            assert view.pixel == other.pixel
            np.testing.assert_array_equal(view.world_from_base.as_matrix(), other.world_from_base.as_matrix())


def test_random_numbers_follow_from_seed_part_and_task():
    first = draw_trials(NEAR, 3, random(4)).pixels
    np.testing.assert_array_equal(first, draw_trials(NEAR, 3, random(4)).pixels)
    assert not np.any(first == draw_trials(NEAR, 3, random(5)).pixels)
    assert not np.any(first == draw_trials(NEAR, 3, generator(11, Part.SLIPS, 4)).pixels)


@pytest.mark.parametrize("taps", [normal, heavy_tailed, correlated, correlated_and_heavy_tailed])
def test_taps_of_every_kind_have_variance_one(taps):
    errors = taps(random(), 20_000, 6)
    assert abs(errors.mean()) < 0.02
    assert 0.9 < errors.var() < 1.1
    lag_one = np.mean(errors[:, :-1] * errors[:, 1:])
    assert lag_one == pytest.approx(CORRELATION if "correlated" in taps.__name__ else 0.0, abs=0.03)
    kurtosis = np.mean(errors**4) / errors.var() ** 2
    assert (kurtosis > 3.5) == ("heavy" in taps.__name__)


@pytest.mark.parametrize("name", SINGULAR)
def test_singular_motions_have_no_bound(name):
    drawn = draw_motions(SINGULAR[name], 20, 4, 1.0, 0.02, random())
    rays = np.concatenate([drawn.targets[:, :2], np.ones((20, 1))], axis=1)
    for views, ray, rho in zip(drawn.sightings(), rays, drawn.targets[:, 2], strict=True):
        point = views[0].world_from_camera.apply(ray / rho)
        bound = position_bound(views, point, OdometryNoise.per_step(0.02))
        assert bound.relative_sd > 1e3


def test_wandering_keeps_the_target_in_the_picture_and_mostly_tells_the_depth():
    drawn = draw_motions(wandering, 200, 4, 1e-6, 0.0, random())
    assert drawn.pixels.min() > -0.5
    assert len(drawn.said) == len(drawn.targets) == 200
    assert np.median(np.abs(drawn.said[:, -1, :2]).sum(axis=1)) > 0.05
