"""A picture of every tap: error over distance, and against what the estimate said of itself."""

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tapreach.bench.accuracy_plot import require_matplotlib
from tapreach.bench.locate_outcome import Outcome

_FLOOR = 0.02
"""Errors below this [%] are drawn there."""


def draw_taps(outcomes: Sequence[Outcome], path: Path) -> None:
    """Write the picture to `path`, its form by the ending; makes the folder. Needs matplotlib."""
    require_matplotlib()
    figure = importlib.import_module("matplotlib.figure").Figure((11.0, 4.2), layout="constrained")
    by_distance, by_word = figure.subplots(1, 2)
    for arm in dict.fromkeys(outcome.arm for outcome in outcomes):
        own = [each for each in outcomes if each.arm == arm and each.range_error is not None]
        errors = [_percent(each.range_error) for each in own]
        by_distance.plot([each.distance for each in own], errors, ".", markersize=5, label=arm)
        sure = [
            (each.relative_sd, error) for each, error in zip(own, errors, strict=True) if each.relative_sd
        ]
        by_word.plot([100.0 * sd for sd, _ in sure], [error for _, error in sure], ".", markersize=5)
    _lines(by_distance, by_word)
    figure.legend(loc="outside lower center", ncols=2)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100, metadata={"Software": None} if path.suffix == ".png" else None)


def _lines(by_distance: Any, by_word: Any) -> None:
    for wanted in (1.0, 4.0):
        by_distance.axhline(wanted, color="0.6", linewidth=1.0)
    by_distance.set(
        title="error of the range [%]; median and 95 % wanted", xlabel="distance [m]", yscale="log"
    )
    said = (0.3, 30.0)
    by_word.plot(said, [1.96 * each for each in said], color="0.6", linewidth=1.0)
    by_word.set(
        title="error of the range [%]; 95 % are to lie below the line",
        xlabel="sigma of the range that the estimate states [%]",
        xscale="log",
        yscale="log",
    )


def _percent(error: float | None) -> float:
    return max(100.0 * abs(error or 0.0), _FLOOR)
