"""One tap of the bench of fetching that is stopped, resumed and ended early, with a fixed seed.

Figures are judged by full runs only.
"""

import asyncio

import pytest
from typer.testing import CliRunner

from tapreach.bench.fetch import run_fetch_bench
from tapreach.bench.fetch_plan import Chapter, smoke_plan
from tapreach.bench.report import read_report, write_report
from tapreach.cli.main import app
from tapreach.robot.clock import MonotonicClock

SEED = 20261122


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fetch")


@pytest.fixture(scope="module")
def report(folder):
    plan = smoke_plan(SEED, Chapter.STOPS, kept=folder / "runs.jsonl", failures=folder / "failures.jpg")
    return asyncio.run(run_fetch_bench(plan, lambda section: None, MonotonicClock()))


def test_fetch_is_stopped_at_once_and_goes_on(report):
    figures = {figure.name: figure for section in report.sections for figure in section.figures}
    assert report.bench == "fetch --part stops"
    assert report.seed == SEED
    assert figures["stops"].value == 1
    assert figures["zero to the wheels: longest"].holds
    assert figures["moved by more than 2 cm after a stop"].value == 0


def test_run_that_went_wrong_is_on_the_sheet_with_its_reason(report, folder):
    wrong = report.sections[1]
    assert wrong.figures[0].value == 1
    assert wrong.grid.rows[0][2].startswith("not done after")
    assert (folder / "failures.jpg").stat().st_size > 10_000
    assert len(list((folder / "failures").glob("*.png"))) == 1


def test_kept_run_is_not_done_again(report, folder):
    plan = smoke_plan(SEED, Chapter.STOPS, kept=folder / "runs.jsonl")
    again = asyncio.run(run_fetch_bench(plan, lambda section: None, MonotonicClock()))
    assert again.sections == report.sections
    assert len((folder / "runs.jsonl").read_text().splitlines()) == 1


def test_report_is_kept_whole(report, tmp_path):
    write_report(report, tmp_path / "fetch.json")
    assert read_report(tmp_path / "fetch.json") == report


@pytest.mark.parametrize(
    "wrong", [["--scenes", "0"], ["--seed", "-1"], ["--jobs", "0"], ["--minutes", "0"], ["--part", "none"]]
)
def test_impossible_plan_is_refused(wrong):
    assert CliRunner().invoke(app, ["bench", "fetch", *wrong]).exit_code == 2
