import dataclasses
import io
from datetime import UTC, datetime

from rich.console import Console

from tapreach.bench.document import benchmarks_document
from tapreach.bench.grid import Grid
from tapreach.bench.report import Report, Section, read_report, this_machine, write_report
from tapreach.bench.table import grid_table

GRID = Grid(("setting", "ours", "theirs"), (("near", "1.0", "2.0"), ("far", "1.1", "—")))
REPORT = Report(
    "accuracy",
    "Accuracy",
    this_machine(datetime(2026, 3, 4, tzinfo=UTC)),
    False,
    (Section("Beside", "Side by side.", (), GRID),),
    seed=4_294_967_295,
)


def test_grid_and_seed_come_back_from_json(tmp_path):
    write_report(REPORT, tmp_path / "accuracy.json")
    assert read_report(tmp_path / "accuracy.json") == REPORT


def test_document_shows_grid_and_seed(tmp_path):
    write_report(REPORT, tmp_path / "accuracy.json")
    text = benchmarks_document(tmp_path)
    assert "| setting | ours | theirs |\n|---|---|---|\n| near | 1.0 | 2.0 |\n| far | 1.1 | — |\n" in text
    assert "Seed 4294967295." in text


def test_document_shows_the_picture_that_lies_beside_the_json(tmp_path):
    write_report(dataclasses.replace(REPORT, seed=None), tmp_path / "accuracy.json")
    assert "![" not in benchmarks_document(tmp_path)
    (tmp_path / "accuracy.png").write_bytes(b"a picture")
    assert "![Accuracy](benchmarks/accuracy.png)" in benchmarks_document(tmp_path)


def test_terminal_shows_every_cell():
    console = Console(file=io.StringIO(), width=100)
    console.print(grid_table(GRID))
    shown = console.file.getvalue()
    assert all(cell in shown for row in (GRID.columns, *GRID.rows) for cell in row)
