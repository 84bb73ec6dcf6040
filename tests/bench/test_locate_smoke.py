"""One tap of the bench of locating, in two of its arms, with a fixed seed.

Figures are judged by full runs only.
"""

import asyncio

import pytest
from typer.testing import CliRunner

from tapreach.bench.locate import run_locate
from tapreach.bench.locate_plan import smoke_plan
from tapreach.bench.report import read_report, write_report
from tapreach.cli.main import app
from tapreach.robot.clock import MonotonicClock

SEED = 20261122


@pytest.fixture(scope="module")
def report():
    return asyncio.run(run_locate(smoke_plan(SEED), lambda section: None, MonotonicClock()))


def test_every_arm_is_measured_on_the_same_tap(report):
    assert report.is_smoke
    assert report.seed == SEED
    *arms, beside = report.sections
    assert [section.figures[0].value for section in arms] == [1, 1]
    assert [row[0] for row in beside.grid.rows] == [
        "chosen move, background",
        "fixed move",
        "fixed move, paper's formula",
    ]
    assert all(len(row) == len(beside.grid.columns) for row in beside.grid.rows)


def test_only_the_first_arm_is_held_to_the_limits(report):
    first, *others = report.sections
    assert any(figure.limit is not None for figure in first.figures)
    assert all(figure.limit is None for section in others for figure in section.figures)


def test_report_is_kept_whole(report, tmp_path):
    write_report(report, tmp_path / "locate.json")
    assert read_report(tmp_path / "locate.json") == report


@pytest.mark.parametrize("wrong", [["--taps", "0"], ["--seed", "-1"], ["--jobs", "0"], ["--minutes", "0"]])
def test_impossible_plan_is_refused(wrong):
    assert CliRunner().invoke(app, ["bench", "locate", *wrong]).exit_code == 2
