"""A picture of every setting: error over bound, regions and consistency, where matplotlib is installed."""

import importlib
import importlib.util
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tapreach.bench.accuracy_cells import CellResult
from tapreach.bench.accuracy_judged import CellFigures, Judged
from tapreach.bench.accuracy_trials import VIEWS
from tapreach.errors import ConfigError


@dataclass(frozen=True)
class _Panel:
    """A figure of a setting, and in what unit it is drawn."""

    title: str
    of: Callable[[CellFigures], Judged]
    unit_per: float = 1.0


_PANELS = (
    _Panel("error of 1/Z over the bound", lambda figures: figures.error),
    _Panel("95 % regions that hold the truth [%]", lambda figures: figures.region, 100.0),
    _Panel("NEES/3", lambda figures: figures.consistency),
)


def require_matplotlib() -> None:
    """Raise ConfigError, saying what to install, where there is nothing to draw with."""
    if importlib.util.find_spec("matplotlib") is None:
        raise ConfigError("a plot needs matplotlib, which is not installed; it is in the extra `plot`")


def draw_settings(results: Sequence[CellResult], path: Path) -> None:
    """Write the picture to `path`, its form by the ending; makes the folder. Needs matplotlib."""
    require_matplotlib()
    figure = importlib.import_module("matplotlib.figure").Figure((11.0, 4.0), layout="constrained")
    for axes, panel in zip(figure.subplots(1, len(_PANELS)), _PANELS, strict=True):
        _draw(axes, panel, results)
    marks = figure.axes[0].get_legend_handles_labels()
    figure.legend(*marks, loc="outside lower center", ncols=len(VIEWS) + 1)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100, metadata={"Software": None} if path.suffix == ".png" else None)


def _draw(axes: Any, panel: _Panel, results: Sequence[CellResult]) -> None:
    wanted = panel.of(results[0].figures).wanted
    low, high = (panel.unit_per * end for end in (wanted.low, wanted.high))
    axes.axhspan(low or 0.98, high, color="tab:green", alpha=0.15, label="wanted")
    for views in VIEWS:
        of_views = [result for result in results if result.cell.views == views]
        judged = [panel.of(result.figures) for result in of_views]
        axes.errorbar(
            [result.relative_sd for result in of_views],
            [panel.unit_per * each.value for each in judged],
            [panel.unit_per * each.chance for each in judged],
            fmt="o",
            markersize=4,
            label=f"{views} views",
        )
    axes.set(title=panel.title, xlabel="sd(1/Z)·Z of the bound", xscale="log")
