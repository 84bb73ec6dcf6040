"""Every setting of depth, views and noise: error over the bound, and whether the regions are honest."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from tapreach.bench.accuracy_intervals import interval_figures
from tapreach.bench.accuracy_outcomes import Outcomes, estimate_all, joined
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_taps import Taps, normal
from tapreach.bench.accuracy_trials import Cell, Trials, all_cells, draw_trials
from tapreach.bench.figure import Figure, at_least, at_most, exactly, known
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.errors import InputError
from tapreach.estimation.bound import position_bound
from tapreach.estimation.observation import Observation

WIDEST = 0.3
"""sd(1/Z)·Z up to which the error is held against the bound."""
CHANCE = 3.0
"""Standard errors beyond a limit that are no chance any more, in about one of 740 settings."""


@dataclass(frozen=True)
class CellResult:
    """A setting, what was answered, and the bound: sd [1/m] of the inverse depth and sd(1/Z)·Z."""

    cell: Cell
    outcomes: Outcomes
    bound_sd: float
    relative_sd: float

    @property
    def error_over_bound(self) -> float:
        """Root mean square error of the inverse depth over its bound."""
        return self.outcomes.error_over(self.bound_sd)

    @property
    def answers(self) -> int:
        """Trials with an answer."""
        return int(self.outcomes.is_answered.sum())


def run_cell(task: tuple[int, Cell], seed: int, part: Part, trials: int, taps: Taps) -> CellResult:
    """Run the trials of one setting; `task` is its number and the setting."""
    number, cell = task
    drawn = draw_trials(cell, trials, generator(seed, part, number), taps)
    bound_sd = bound_of(cell, next(drawn.sightings()), drawn)
    return CellResult(cell, estimate_all(drawn, cell.noise), bound_sd, bound_sd * cell.depth)


def bound_of(cell: Cell, observations: list[Observation], trials: Trials) -> float:
    """Return the Cramér-Rao bound [1/m] on the inverse depth for the poses said and the true target."""
    a, b, rho = trials.targets[0]
    point = observations[0].world_from_camera.apply(np.array([a, b, 1.0]) / rho)
    bound = position_bound(observations, point, cell.noise)
    if bound is None or not math.isfinite(bound.relative_sd):
        raise InputError(f"the setting {cell} has no bound: its motion tells nothing of the depth")
    return bound.relative_sd * float(rho)


def run_cells(plan: AccuracyPlan) -> list[CellResult]:
    """Run every setting."""
    one = partial(run_cell, seed=plan.seed, part=Part.CELLS, trials=plan.trials, taps=normal)
    return spread(one, list(enumerate(all_cells())), plan.jobs)


def cells_section(results: list[CellResult], trials: int) -> Section:
    """Return the figures over all settings and the table of every one."""
    return Section(
        "Every setting",
        "640 by 480 px, focal length 600 px, camera 10 cm ahead of the axis and pitched 10° down. The base "
        "turns 12° and goes straight on, 20, 30 or 40 cm in 1, 4 or 19 steps, at most 0.4 of the depth. Taps "
        f"and every turn and advance err by chance, {trials} trials in each setting. Bound: Cramér-Rao, the "
        f"errors of the odometry marginalised; settings with sd(1/Z)·Z up to {WIDEST:g} are held to it. "
        f"Beyond chance: more than {CHANCE:g} standard errors.",
        (*_error_figures(results), *_coverage_figures(results), *_consistency_figures(results)),
        _grid(results),
    )


def intervals_section(results: list[CellResult]) -> Section:
    """Return how often the range intervals of all settings hold the truth."""
    return Section(
        "95 % range interval",
        "The answers of all settings together, then in groups by the width of their own interval (far end "
        "over near end), a fifth of the answers with two ends in each.",
        interval_figures(joined([result.outcomes for result in results])),
    )


def _error_figures(results: list[CellResult]) -> tuple[Figure, ...]:
    held = [result for result in results if result.relative_sd <= WIDEST]
    worst = max(held, key=lambda result: result.error_over_bound)
    spreads = [1.0 / math.sqrt(2.0 * max(result.answers, 1)) for result in held]
    beyond = sum(
        result.error_over_bound * (1.0 - CHANCE * chance) > 1.03
        for result, chance in zip(held, spreads, strict=True)
    )
    pooled = math.sqrt(sum(result.error_over_bound**2 for result in held) / len(held))
    answered = sum(result.answers for result in held) / sum(len(result.outcomes.nees) for result in held)
    return (
        Figure(
            "error over bound: all settings together",
            known(pooled),
            "",
            at_most(1.03),
            f"{len(held)} settings",
        ),
        Figure(
            "error over bound: worst setting",
            known(worst.error_over_bound),
            "",
            at_most(1.03),
            f"{worst.cell}; standard error of one setting {max(spreads):.3f}",
        ),
        Figure("settings above 1.03 beyond chance", beyond, "", exactly(0), f"of {len(held)}"),
        Figure("answered, settings held to the bound", 100.0 * answered, "%"),
    )


def _coverage_figures(results: list[CellResult]) -> tuple[Figure, ...]:
    coverages = [result.outcomes.region_coverage() for result in results]
    chances = [math.sqrt(0.95 * 0.05 / max(result.answers, 1)) for result in results]
    beyond = sum(abs(c - 0.95) > 0.01 + CHANCE * e for c, e in zip(coverages, chances, strict=True))
    pooled = joined([result.outcomes for result in results]).region_coverage()
    note = f"standard error of one setting {100.0 * max(chances):.2f} %"
    return (
        Figure("95 % region: holds the truth, all", known(100.0 * pooled), "%"),
        Figure("95 % region: lowest setting", known(100.0 * min(coverages)), "%", at_least(94.0), note),
        Figure("95 % region: highest setting", known(100.0 * max(coverages)), "%", at_most(96.0)),
        Figure("settings outside 94 to 96 % beyond chance", beyond, "", exactly(0), f"of {len(results)}"),
    )


def _consistency_figures(results: list[CellResult]) -> tuple[Figure, ...]:
    values = [result.outcomes.consistency() for result in results]
    chances = [math.sqrt(2.0 / (3.0 * max(result.answers, 1))) for result in results]
    beyond = sum(abs(v - 1.0) > 0.05 + CHANCE * e for v, e in zip(values, chances, strict=True))
    pooled = joined([result.outcomes for result in results]).consistency()
    note = f"standard error of one setting {max(chances):.3f}"
    return (
        Figure("NEES/3: all", known(pooled)),
        Figure("NEES/3: lowest setting", known(min(values)), "", at_least(0.95), note),
        Figure("NEES/3: highest setting", known(max(values)), "", at_most(1.05)),
        Figure("settings outside 0.95 to 1.05 beyond chance", beyond, "", exactly(0), f"of {len(results)}"),
    )


def _grid(results: list[CellResult]) -> Grid:
    columns = (
        "setting",
        "sd(1/Z)·Z of the bound",
        "error over bound",
        "95 % region",
        "NEES/3",
        "range interval",
        "answered",
    )
    return Grid(columns, tuple(_row(result) for result in results))


def _row(result: CellResult) -> tuple[str, ...]:
    outcomes = result.outcomes
    return (
        str(result.cell),
        f"{result.relative_sd:.3f}",
        f"{result.error_over_bound:.3f}",
        f"{100.0 * outcomes.region_coverage():.1f} %",
        f"{outcomes.consistency():.3f}",
        f"{100.0 * outcomes.interval_coverage():.1f} %",
        f"{100.0 * result.answers / len(outcomes.nees):.1f} %",
    )
