"""Tables of outcomes by distance, by scene and by what was done; and the statistics that they show."""

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np

from tapreach.bench.grid import Grid
from tapreach.bench.locate_outcome import Outcome

_DISTANCES = (0.5, 1.0, 1.5, 2.0, 3.0)
_NOTHING = "—"
COLUMNS = (
    "taps", "refused", "wrong", "range error: median", "95 %", "position: median", "95 %",
    "range interval holds", "NEES of 1/Z", "region of position holds", "NEES/3 of position",
    "driven", "time to answer",
)  # fmt: skip


def grid(own: Sequence[Outcome]) -> Grid:
    """Return the table of one arm by distance and by scene."""
    rows = []
    for low, high in itertools.pairwise(_DISTANCES):
        part = [outcome for outcome in own if low <= outcome.distance < high]
        rows.append((f"{low:g} to {high:g} m", *cells(part)))
    for scene in sorted({outcome.scene for outcome in own}):
        rows.append((scene, *cells([outcome for outcome in own if outcome.scene == scene])))
    return Grid(("", *COLUMNS), tuple(rows))


def cells(part: Sequence[Outcome]) -> tuple[str, ...]:
    """Return the cells of a row, under COLUMNS."""
    ranged = [outcome for outcome in part if outcome.range_error is not None]
    answered = [outcome for outcome in part if outcome.is_answered]
    ranges, positions = list(map(range_error, ranged)), list(map(position_error, answered))
    return (
        str(len(part)),
        str(len(part) - len(ranged)),
        str(sum(outcome.is_wrong for outcome in part)) if answered else _NOTHING,
        _shown(percent(ranges, 50.0), " %"),
        _shown(percent(ranges, 95.0), " %"),
        _shown(percent(positions, 50.0), " %"),
        _shown(percent(positions, 95.0), " %"),
        _shown(100.0 * share(answered, lambda each: bool(each.holds_range)), " %"),
        _shown(mean([each.nees_depth for each in answered]), ""),
        _shown(100.0 * share(answered, lambda each: each.holds_position), " %"),
        _shown(mean([each.nees_position for each in answered]) / 3.0, ""),
        _shown(100.0 * at([each.driven for each in part], 50.0), " cm"),
        _shown(at([each.seconds for each in part], 50.0), " s"),
    )


def range_error(outcome: Outcome) -> float:
    """Return how far off the range is, over the range; of an outcome that has one."""
    return abs(outcome.range_error or 0.0)


def position_error(outcome: Outcome) -> float:
    """Return the same of the position."""
    return outcome.position_error or 0.0


def mean(values: Sequence[float | None]) -> float:
    """Return the mean of those that are there; NaN of none."""
    there = [value for value in values if value is not None]
    return float(np.mean(there)) if there else math.nan


def share(part: Sequence[Outcome], is_so: Callable[[Outcome], bool]) -> float:
    """Return the share of those of which it is so; NaN of none."""
    return sum(map(is_so, part)) / len(part) if part else math.nan


def percent(errors: Sequence[float], percent: float) -> float:
    """Return a percentile in percent; NaN of none."""
    return 100.0 * at(errors, percent)


def at(values: Sequence[float], percent: float) -> float:
    """Return a percentile; NaN of none."""
    return float(np.percentile(values, percent)) if values else math.nan


def _shown(value: float, unit: str) -> str:
    return _NOTHING if math.isnan(value) else f"{value:.1f}{unit}"
