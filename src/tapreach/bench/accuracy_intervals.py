"""Whether 95 % range intervals hold the truth: of all answers, and of those equally sure."""

import itertools
import math

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_outcomes import Outcomes
from tapreach.bench.figure import Figure, at_most

GROUPS = 5
WANTED, MARGIN = 95.0, 2.0


def interval_figures(outcomes: Outcomes) -> tuple[Figure, ...]:
    """Return how far coverage is off 95 % [percentage points]: all, by width, and with an open far end."""
    is_closed = outcomes.has_interval & np.isfinite(outcomes.farthest)
    figures = [_off("all intervals", outcomes, outcomes.has_interval)]
    if np.any(is_closed):
        widths = np.where(is_closed, outcomes.farthest / outcomes.nearest, np.nan)
        edges = np.nanquantile(widths, np.linspace(0.0, 1.0, GROUPS + 1))
        edges[-1] = np.inf
        for low, high in itertools.pairwise(edges.tolist()):
            chosen = is_closed & (widths >= low) & (widths < high)
            until = f"to {high:.3g}" if math.isfinite(high) else "and more"
            figures.append(_off(f"far over near end {low:.3g} {until}", outcomes, chosen))
    figures.append(_off("far end open", outcomes, outcomes.has_interval & ~is_closed))
    return tuple(figures)


def _off(name: str, outcomes: Outcomes, chosen: npt.NDArray[np.bool_]) -> Figure:
    count = int(chosen.sum())
    if not count:
        return Figure(f"{name}: off 95 % by", None, "%", None, "there were none")
    coverage = 100.0 * float(np.mean(outcomes.is_range_held[chosen]))
    chance = math.sqrt(WANTED * (100.0 - WANTED) / count)
    note = f"holds {coverage:.1f} % of {count}; standard error {chance:.1f} %"
    return Figure(f"{name}: off 95 % by", abs(coverage - WANTED), "%", at_most(MARGIN), note)
