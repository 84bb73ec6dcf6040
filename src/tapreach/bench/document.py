"""Writes docs/benchmarks.md from the JSON of the last full runs in docs/benchmarks/."""

from pathlib import Path

from tapreach.bench.figure import Figure
from tapreach.bench.grid import Grid
from tapreach.bench.report import Report, Section, read_report
from tapreach.errors import ConfigError

_HEAD = """\
# Benchmarks

Generated from `docs/benchmarks/*.json`, the last full run of each bench; to renew it:

    tapreach bench video --json docs/benchmarks/video.json
    tapreach bench control --json docs/benchmarks/control.json
    tapreach bench accuracy --plot docs/benchmarks/accuracy.png --json docs/benchmarks/accuracy.json
    tapreach bench locate --jobs 2 --plot docs/benchmarks/locate.png --json docs/benchmarks/locate.json
    tapreach bench fetch --jobs 2 --json docs/benchmarks/fetch.json
    tapreach bench online --json docs/benchmarks/online.json
    tapreach bench firmware --json docs/benchmarks/firmware.json
    tapreach bench run --json docs/benchmarks/run.json
    tapreach bench document

Milliseconds belong to the machine named with each bench. What carries over to another machine are the
ratios and counts, so most limits are set on those, against a peer or a limit measured in the same run.
Everything runs over loopback on one machine; a real network adds its own delay.
"""
_VERDICT = {True: "yes", False: "**no**", None: ""}


def benchmarks_document(folder: Path) -> str:
    """Return the text of docs/benchmarks.md for the reports in `folder`, in the order of their names.

    Raises ConfigError for a file that is no report, or a smoke run: too short to be worth publishing.
    """
    reports = [_full_report(path) for path in sorted(folder.glob("*.json"))]
    return "\n".join([_HEAD, *(_report_text(report, folder) for report in reports)])


def _full_report(path: Path) -> Report:
    report = read_report(path)
    if report.is_smoke:
        raise ConfigError(f"{path} is a smoke run, too short to be published: run the bench without --smoke")
    return report


def _report_text(report: Report, folder: Path) -> str:
    picture = f"{report.bench}.png"
    shown = [f"![{report.title}](benchmarks/{picture})", ""] if (folder / picture).exists() else []
    head = f"`tapreach bench {report.bench}` on: {report.machine}.{_seed(report)}"
    sections = [_section_text(section) for section in report.sections]
    return "\n".join([f"## {report.title}", "", head, "", *shown, *sections])


def _seed(report: Report) -> str:
    return "" if report.seed is None else f" Seed {report.seed}."


def _section_text(section: Section) -> str:
    rows = ["| figure | measured | wanted | holds | note |", "|---|---:|---:|---|---|"]
    rows += [_row(figure) for figure in section.figures]
    grid = [] if section.grid is None else _grid_rows(section.grid)
    return "\n".join([f"### {section.title}", "", section.method, "", *rows, "", *grid])


def _grid_rows(grid: Grid) -> list[str]:
    head = ["| " + " | ".join(grid.columns) + " |", "|---" * len(grid.columns) + "|"]
    return [*head, *("| " + " | ".join(row) + " |" for row in grid.rows), ""]


def _row(figure: Figure) -> str:
    cells = (figure.name, figure.shown, figure.wanted, _VERDICT[figure.holds], figure.note)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
