import io
from datetime import UTC, datetime

import pytest
from rich.console import Console

from tapreach.bench.document import benchmarks_document
from tapreach.bench.figure import Figure, at_most, exactly
from tapreach.bench.report import Report, Section, read_report, this_machine, write_report
from tapreach.bench.table import print_closing, section_table
from tapreach.errors import ConfigError


def report(is_smoke: bool = False) -> Report:
    figures = (
        Figure("age | median", 2.25, "ms", at_most(3)),
        Figure("left over", 1, "", exactly(0), note="one too many"),
        Figure("rate", 29.9, "Hz"),
    )
    machine = this_machine(datetime(2026, 3, 4, tzinfo=UTC))
    return Report("video", "Video", machine, is_smoke, (Section("Viewers", "Four viewers.", figures),))


def test_report_comes_back_from_json_as_written(tmp_path):
    path = tmp_path / "new" / "video.json"
    write_report(report(), path)
    assert read_report(path) == report()


def test_file_that_is_no_report_is_named(tmp_path):
    path = tmp_path / "video.json"
    path.write_text('{"bench": 3}')
    with pytest.raises(ConfigError, match=r"video\.json is not the JSON of a bench"):
        read_report(path)


def test_broken_figures_are_those_beyond_their_limit():
    assert [figure.name for figure in report().broken] == ["left over"]


def test_machine_is_told_with_cores_and_load():
    machine = this_machine(datetime(2026, 3, 4, tzinfo=UTC))
    assert machine.cores >= 1
    assert machine.date == "2026-03-04"
    assert f"{machine.cores} cores, load {machine.load:.1f}" in str(machine)


def test_table_shows_every_figure_and_how_many_hold():
    console = Console(file=io.StringIO(), width=160)
    console.print(section_table(report().sections[0]))
    print_closing(report(), console)
    shown = console.file.getvalue()
    assert all(figure.name in shown and figure.shown in shown for figure in report().figures)
    assert "1 of 2 wanted figures hold" in shown


def test_document_has_a_row_for_every_figure(tmp_path):
    write_report(report(), tmp_path / "video.json")
    text = benchmarks_document(tmp_path)
    assert "| age \\| median | 2.25 ms | ≤ 3 ms | yes |  |" in text
    assert "| left over | 1 | = 0 | **no** | one too many |" in text
    assert "| rate | 29.9 Hz |  |  |  |" in text


def test_smoke_run_is_not_published(tmp_path):
    write_report(report(is_smoke=True), tmp_path / "video.json")
    with pytest.raises(ConfigError, match="smoke run"):
        benchmarks_document(tmp_path)
