"""Every setting of depth, views and noise: error over the bound, and whether the regions are honest."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from tapreach.bench.accuracy_intervals import interval_figures
from tapreach.bench.accuracy_judged import CellFigures, Judged, judged_cell
from tapreach.bench.accuracy_linear import Linear, linear
from tapreach.bench.accuracy_outcomes import Outcomes, estimate_all, joined
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_trials import Cell, Trials, all_cells, draw_trials, well_defined_drive
from tapreach.bench.figure import Figure, exactly, within
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.geometry.finite import FloatArray

WIDEST = 0.3
"""sd(1/Z)·Z up to which the error is held against the bound."""


@dataclass(frozen=True)
class CellResult:
    """A setting, what was answered, and what the best linear estimate would have missed by (m, 3)."""

    cell: Cell
    outcomes: Outcomes
    linear_errors: FloatArray
    experiment: Linear

    @property
    def relative_sd(self) -> float:
        """sd(1/Z)·Z of the bound."""
        return float(self.experiment.inverse_depth_sd) * self.cell.depth

    @property
    def is_held(self) -> bool:
        """True where the error is held against the bound."""
        return self.relative_sd <= WIDEST

    @cached_property
    def figures(self) -> CellFigures:
        """Error, region and consistency, each with its chance."""
        return judged_cell(self.outcomes, self.linear_errors, self.experiment)

    @property
    def is_told(self) -> bool:
        """True where every figure can be told from its limits."""
        figures = self.figures
        judged = figures.all if self.is_held else (figures.region, figures.consistency)
        return all(each.is_told for each in judged)


def run_cell(task: tuple[int, Cell], seed: int, trials: int, rounds: int) -> CellResult:
    """Run one setting, `task` its number and itself, in up to so many rounds of `trials` until `is_told`."""
    number, cell = task
    random = generator(seed, Part.CELLS, number)
    parts: list[tuple[Outcomes, FloatArray]] = []
    while True:
        drawn = draw_trials(cell, trials, random)
        experiment = experiment_of(cell, drawn)
        parts.append((estimate_all(drawn, cell.noise), experiment.errors_of(drawn.chance)))
        outcomes, errors = zip(*parts, strict=True)
        result = CellResult(cell, joined(outcomes), np.concatenate(errors), experiment)
        if result.is_told or len(parts) == rounds:
            return result


def experiment_of(cell: Cell, trials: Trials, unused: int | None = None) -> Linear:
    """Return the linear experiment of a setting, without the view `unused` where it is given."""
    sigmas = np.full(cell.views, cell.pixel_sigma)
    if unused is not None:
        sigmas[unused] = np.inf
    return linear(well_defined_drive(cell), trials.targets[0], sigmas, cell.odometry)


def run_cells(plan: AccuracyPlan) -> list[CellResult]:
    """Run every setting."""
    one = partial(run_cell, seed=plan.seed, trials=plan.trials, rounds=plan.rounds)
    return spread(one, list(enumerate(all_cells())), plan.jobs)


def cells_section(results: list[CellResult], plan: AccuracyPlan) -> Section:
    """Return the figures over all settings and the table of every one."""
    held = [result for result in results if result.is_held]
    counts = [len(result.outcomes.nees) for result in results]
    answered = sum(int(result.outcomes.is_answered.sum()) for result in held)
    return Section(
        "Every setting",
        "640 by 480 px, focal length 600 px, camera 10 cm ahead of the axis and pitched 10° down. The base "
        "turns 12° and goes straight on, 20, 30 or 40 cm in 1, 4 or 19 steps, at most 0.4 of the depth. Taps "
        "and every turn and advance err by chance. Bound: Cramér-Rao, the errors of the odometry "
        f"marginalised, by differences of the bench's own scene; settings with sd(1/Z)·Z up to {WIDEST:g} "
        "are held to it. From each figure what the best linear estimate shows in the same trials to be "
        "chance is subtracted; ± is the standard error that remains. A setting gets "
        f"{plan.trials} trials, and as many again, up to {plan.rounds} times, while a figure is nearer to a "
        f"limit than 2.5 of them ({sum(counts)} trials in all, {max(counts)} at most).",
        (
            *_figures("error over bound", held, lambda figures: figures.error, 1.0, ""),
            Figure(
                "answered, settings held to the bound",
                100.0 * answered / sum(len(result.outcomes.nees) for result in held),
                "%",
            ),
            *_figures("95 % region", results, lambda figures: figures.region, 100.0, "%"),
            *_figures("NEES/3", results, lambda figures: figures.consistency, 1.0, ""),
        ),
        _grid(results),
    )


def intervals_section(results: list[CellResult], trials: int) -> Section:
    """Return how often the range intervals of all settings hold the truth, equally many from each."""
    return Section(
        "95 % range interval",
        f"The first {trials} answers of every setting together, then in groups by the width of their own "
        "interval (far end over near end), a quarter of those with two ends in each. With a few fixed "
        "depths, answers whose far end is open are those in which chance made the target look far, so that "
        "the lower limit is too large more often; with targets all over the range it is not (next part).",
        interval_figures(joined([result.outcomes.first(trials) for result in results])),
    )


def _figures(
    name: str, results: Sequence[CellResult], of: Callable[[CellFigures], Judged], unit_per: float, unit: str
) -> tuple[Figure, ...]:
    """Return lowest and highest setting against the limits, and how many chance cannot excuse."""
    judged = [of(result.figures) for result in results]
    wanted = within(unit_per * judged[0].wanted.low, unit_per * judged[0].wanted.high)

    def end(which: str, each: Judged) -> Figure:
        cell = results[judged.index(each)].cell
        note = f"± {unit_per * each.chance:.2g}; {cell}"
        return Figure(f"{name}: {which} setting", unit_per * each.value, unit, wanted, note)

    mean = unit_per * sum(map(_value, judged)) / len(judged)
    broken = sum(each.is_broken for each in judged)
    return (
        Figure(f"{name}: mean of {len(judged)} settings", mean, unit),
        end("lowest", min(judged, key=_value)),
        end("highest", max(judged, key=_value)),
        Figure(f"{name}: settings beyond a limit by more than chance", broken, "", exactly(0)),
    )


def _value(judged: Judged) -> float:
    return judged.value


def _grid(results: list[CellResult]) -> Grid:
    columns = ("setting", "sd(1/Z)·Z of the bound", "error over bound", "95 % region", "NEES/3")
    return Grid((*columns, "range interval", "answered", "trials"), tuple(_row(result) for result in results))


def _row(result: CellResult) -> tuple[str, ...]:
    outcomes, figures = result.outcomes, result.figures
    return (
        str(result.cell),
        f"{result.relative_sd:.3f}",
        f"{figures.error.value:.3f} ± {figures.error.chance:.3f}",
        f"{100.0 * figures.region.value:.1f} ± {100.0 * figures.region.chance:.1f} %",
        f"{figures.consistency.value:.3f} ± {figures.consistency.chance:.3f}",
        f"{100.0 * outcomes.interval_coverage():.1f} %",
        f"{100.0 * outcomes.is_answered.mean():.1f} %",
        str(len(outcomes.nees)),
    )
