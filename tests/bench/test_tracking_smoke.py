"""The tracking bench in its short form and with a fixed seed. Figures are judged by full runs only."""

import asyncio

import numpy as np
import pytest
from typer.testing import CliRunner

from tapreach.bench.report import read_report, write_report
from tapreach.bench.tracking import run_tracking
from tapreach.bench.tracking_film import Tapped
from tapreach.bench.tracking_outcomes import outcome_of
from tapreach.bench.tracking_plan import smoke_plan
from tapreach.bench.tracking_run import Run
from tapreach.cli.main import app
from tapreach.geometry.pixel import Pixel
from tapreach.robot.clock import MonotonicClock

SEED = 20261122
PICTURES = 12


@pytest.fixture(scope="module")
def report():
    return asyncio.run(run_tracking(smoke_plan(SEED), lambda section: None, MonotonicClock()))


def run_of(errors, visible=None, sigma=1.0, scale=1.0) -> Run:
    """A point that goes right by 5 px a picture, followed with `errors` [px] to the right; NaN is lost."""
    errors = np.array(errors, dtype=float)
    count = len(errors)
    truth = np.stack([100.0 + 5.0 * np.arange(count + 1), np.full(count + 1, 50.0)], axis=1)
    seen = np.ones(count + 1, bool) if visible is None else np.array([True, *visible])
    depths = np.r_[1.0, np.full(count, 1.0 / scale)]
    tapped = Tapped(Pixel(100.0, 50.0), truth, seen, depths)
    pixels = truth[1:] + np.stack([errors, 0.0 * errors], axis=1)
    return Run(tapped, pixels, np.full(count, sigma), np.ones(count, bool), np.ones(count))


def test_both_parts_are_measured(report):
    assert [section.title for section in report.sections] == ["Tapped points followed", "Beside OpenCV"]
    assert report.is_smoke
    assert report.seed == SEED
    figures = {figure.name: figure.value for figure in report.sections[0].figures}
    assert figures["points"] >= 1
    assert 0.0 <= figures["drift: median"] < 5.0
    assert {row[1] for row in report.sections[1].grid.rows} == {"tapreach", "KLT", "KLT from the first"}


def test_report_of_tracking_is_kept_whole(report, tmp_path):
    write_report(report, tmp_path / "tracking.json")
    assert read_report(tmp_path / "tracking.json") == report


def test_command_offers_seed_and_taps():
    result = CliRunner().invoke(app, ["bench", "tracking", "--help"], catch_exceptions=False)
    assert result.exit_code == 0
    assert all(option in result.output for option in ("--seed", "--taps", "--smoke", "--json"))


def test_drift_is_that_of_the_last_visible_picture():
    outcome = outcome_of([run_of([0.1] * (PICTURES - 1) + [2.0], scale=4.0)])
    assert outcome.drift_median == pytest.approx(2.0)
    assert outcome.in_first_median == pytest.approx(0.5)


def test_jump_counts_once_and_only_when_not_said_lost():
    fine, lost = run_of([0.2] * PICTURES), run_of([0.2] * 6 + [np.nan] * 6)
    jumped, doubted = run_of([0.2] * 6 + [30.0] * 6), run_of([9.0] * PICTURES, sigma=9.0)
    assert outcome_of([fine, lost]).jumped == 0.0
    assert outcome_of([fine, jumped]).jumped == 50.0
    assert outcome_of([fine, doubted]).jumped == 50.0
    assert outcome_of([fine, doubted]).jumped_unsaid == 0.0


def test_nearer_thing_may_be_off_by_more_pixels():
    assert outcome_of([run_of([10.0] * PICTURES, scale=5.0)]).jumped == 0.0
    assert outcome_of([run_of([16.0] * PICTURES, scale=5.0)]).jumped == 100.0


def test_lost_counts_only_where_it_can_be_seen():
    visible = [True] * 6 + [False] * 6
    assert outcome_of([run_of([0.2] * 6 + [np.nan] * 6, visible)]).lost == 0.0
    assert outcome_of([run_of([0.2] * 3 + [np.nan] * 9, visible)]).lost == 50.0


def test_point_that_came_back_must_be_found_in_time():
    visible = [True] * 3 + [False] * 4 + [True] * 5
    found = run_of([0.2] * 3 + [np.nan] * 6 + [0.2] * 3, visible)
    given_up = run_of([0.2] * 3 + [np.nan] * 9, visible)
    assert outcome_of([found]).found_again == 100.0
    assert outcome_of([found, given_up]).found_again == 50.0
    assert outcome_of([run_of([0.2] * PICTURES)]).found_again is None


def test_error_over_sigma_is_one_for_honest_sigmas():
    rng = np.random.default_rng(4)
    runs = [run_of(rng.normal(0.0, 1.5, 40), sigma=1.5 / np.sqrt(2.0)) for _ in range(30)]
    assert outcome_of(runs).normalised == pytest.approx(1.0, abs=0.1)
