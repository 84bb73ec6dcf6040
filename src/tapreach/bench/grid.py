"""A table of many cells within a section: for what is read side by side rather than held to a limit."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Grid:
    """Rows of text under their columns; every row as long as `columns`."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
