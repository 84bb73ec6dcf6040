"""Seeds of `tapreach bench accuracy`: a fresh one each run unless given, and told either way."""

import re

import pytest
from typer.testing import CliRunner

from tapreach.bench import accuracy
from tapreach.bench.report import read_report
from tapreach.bench.spread import spread
from tapreach.cli.main import app


@pytest.fixture
def seeds(monkeypatch):
    """Only the seed is looked at: every part of the bench is left out."""
    used = []

    async def only_the_series(bench, title, is_smoke, measurements, on_section, clock, seed):
        used.append(seed)
        return await run_series(bench, title, is_smoke, (), on_section, clock, seed)

    run_series = accuracy.run_series
    monkeypatch.setattr(accuracy, "run_series", only_the_series)
    return used


def run(path, *arguments):
    command = ["bench", "accuracy", "--json", str(path), *arguments]
    result = CliRunner().invoke(app, command, catch_exceptions=False)
    assert result.exit_code == 0
    return int(re.search(r"seed (\d+)", result.output).group(1))


def test_seed_is_fresh_each_time_printed_and_stored(seeds, tmp_path):
    printed = [run(tmp_path / f"{i}.json") for i in range(3)]
    assert len(set(printed)) == 3
    assert seeds == printed == [read_report(tmp_path / f"{i}.json").seed for i in range(3)]


def test_given_seed_is_used(seeds, tmp_path):
    assert run(tmp_path / "given.json", "--seed", "7", "--smoke") == 7
    assert seeds == [7]


def test_work_over_two_processes_gives_what_one_gives():
    assert spread(abs, [-3, 2, -1], 1) == spread(abs, [-3, 2, -1], 2) == [3, 2, 1]
