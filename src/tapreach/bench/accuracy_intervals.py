"""Whether 95 % range intervals hold the truth: of all answers, and of those equally sure."""

import itertools
import math

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_outcomes import Outcomes
from tapreach.bench.figure import Figure, within

GROUPS = 4
WANTED = within(93.0, 97.0)


def interval_figures(outcomes: Outcomes) -> tuple[Figure, ...]:
    """Return how many intervals hold the truth: of all, by width in quarters, and with an open far end."""
    is_closed = outcomes.has_interval & np.isfinite(outcomes.farthest)
    figures = [
        _held("all intervals", outcomes, outcomes.has_interval),
        _held("both ends known", outcomes, is_closed),
        _held("far end open", outcomes, outcomes.has_interval & ~is_closed),
    ]
    if not np.any(is_closed):
        return tuple(figures)
    widths = np.where(is_closed, outcomes.farthest / outcomes.nearest, np.nan)
    edges = np.nanquantile(widths, np.linspace(0.0, 1.0, GROUPS + 1))
    edges[-1] = np.inf
    for low, high in itertools.pairwise(edges.tolist()):
        chosen = is_closed & (widths >= low) & (widths < high)
        until = f"to {high:.3g}" if math.isfinite(high) else "and more"
        figures.append(_held(f"far over near end {low:.3g} {until}", outcomes, chosen))
    return tuple(figures)


def _held(name: str, outcomes: Outcomes, chosen: npt.NDArray[np.bool_]) -> Figure:
    count = int(chosen.sum())
    if not count:
        return Figure(f"{name}: hold the truth", None, "%", None, "there were none")
    held = 100.0 * float(np.mean(outcomes.is_range_held[chosen]))
    chance = math.sqrt(95.0 * 5.0 / count)
    return Figure(f"{name}: hold the truth", held, "%", WANTED, f"± {chance:.1g}; {count} answers")
