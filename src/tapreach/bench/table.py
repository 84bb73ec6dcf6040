"""A report on the terminal."""

from rich.console import Console
from rich.table import Table

from tapreach.bench.figure import Figure
from tapreach.bench.grid import Grid
from tapreach.bench.report import Report, Section

_VERDICT = {True: "[green]holds[/]", False: "[red]does not hold[/]", None: ""}


def print_closing(report: Report, console: Console) -> None:
    """Print the machine, and how many of the wanted figures hold."""
    limited = [figure for figure in report.figures if figure.limit is not None]
    console.print(f"[bold]{report.title}[/]  {report.machine}", highlight=False)
    console.print(f"{len(limited) - len(report.broken)} of {len(limited)} wanted figures hold")


def section_table(section: Section) -> Table:
    """Return the table of one section: figure, measured, wanted, verdict, note."""
    table = Table(title=section.title, caption=section.method, title_justify="left", caption_justify="left")
    table.add_column("figure")
    table.add_column("measured", justify="right", no_wrap=True)
    table.add_column("wanted", justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    table.add_column("note")
    for figure in section.figures:
        table.add_row(*_cells(figure))
    return table


def grid_table(grid: Grid) -> Table:
    """Return the table of what is read side by side."""
    table = Table(*grid.columns)
    for row in grid.rows:
        table.add_row(*row)
    return table


def _cells(figure: Figure) -> tuple[str, str, str, str, str]:
    return figure.name, figure.shown, figure.wanted, _VERDICT[figure.holds], figure.note
