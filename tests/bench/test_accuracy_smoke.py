"""The accuracy bench in its short form and with a fixed seed. Figures are judged by full runs only."""

import asyncio

import cv2
import pytest
from typer.testing import CliRunner

from tapreach.bench import accuracy_plot
from tapreach.bench.accuracy import run_accuracy
from tapreach.bench.accuracy_cells import run_cell
from tapreach.bench.accuracy_plan import Chapter, smoke_plan
from tapreach.bench.accuracy_trials import Cell
from tapreach.bench.report import read_report, write_report
from tapreach.cli.main import app
from tapreach.errors import ConfigError
from tapreach.robot.clock import MonotonicClock

SEED = 20261122


@pytest.fixture(scope="module")
def report():
    return asyncio.run(run_accuracy(smoke_plan(SEED), lambda section: None, MonotonicClock()))


def figures(report):
    return {(s.title, f.name): f.value for s in report.sections for f in s.figures}


def test_every_part_is_measured(report):
    assert [section.title for section in report.sections] == [
        "Beside others",
        "Every setting",
        "95 % range interval",
        "Random motions",
        "The chosen move",
        "One slipped tap among five",
        "Taps that are correlated or heavy-tailed",
    ]
    assert report.is_smoke
    assert report.seed == SEED


def test_tables_show_every_setting_and_every_peer(report):
    beside, settings = (section.grid for section in report.sections[:2])
    assert len(settings.rows) == 48
    assert len(beside.rows) == 12
    assert all(len(row) == len(grid.columns) for grid in (beside, settings) for row in grid.rows)
    assert {"tapreach", "OpenCV", "paper"} < set(beside.columns)


def test_nothing_breaks_and_nothing_singular_gets_a_range(report):
    measured = figures(report)
    assert measured["Random motions", "exceptions and warnings"] == 0
    assert measured["Random motions", "answers behind a camera"] == 0
    assert measured["Random motions", "motions"] >= 24


def test_errors_are_of_the_size_of_the_bound(report):
    together = figures(report)["Every setting", "error over bound: mean of 44 settings"]
    assert 0.8 < together < 1.2


def test_chapter_alone_is_all_that_runs():
    alone = asyncio.run(run_accuracy(smoke_plan(SEED, Chapter.SLIPS), lambda section: None, MonotonicClock()))
    assert [section.title for section in alone.sections] == ["One slipped tap among five"]
    assert alone.bench == "accuracy --part slips"


def test_report_is_kept_whole(report, tmp_path):
    write_report(report, tmp_path / "accuracy.json")
    assert read_report(tmp_path / "accuracy.json") == report


def test_command_offers_seed_trials_and_json():
    result = CliRunner().invoke(app, ["bench", "accuracy", "--help"], catch_exceptions=False)
    assert result.exit_code == 0
    assert all(option in result.output for option in ("--seed", "--trials", "--part", "--smoke", "--json"))


@pytest.mark.parametrize("wrong", [["--trials", "0"], ["--seed", "-1"], ["--jobs", "none"]])
def test_impossible_plan_is_refused(wrong):
    assert CliRunner().invoke(app, ["bench", "accuracy", *wrong]).exit_code == 2


def test_plot_without_matplotlib_says_what_is_missing(tmp_path, monkeypatch):
    monkeypatch.setattr(accuracy_plot.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ConfigError, match="matplotlib"):
        accuracy_plot.draw_settings([], tmp_path / "settings.png")


def test_plot_is_a_picture(tmp_path):
    pytest.importorskip("matplotlib", reason="matplotlib is not installed: nothing to draw with")
    cell = Cell(1.0, 2, 1.0, 0.01)
    result = run_cell((0, cell), seed=SEED, trials=3, rounds=1)
    accuracy_plot.draw_settings([result], tmp_path / "new" / "settings.png")
    assert cv2.imread(str(tmp_path / "new" / "settings.png")).shape[2] == 3
