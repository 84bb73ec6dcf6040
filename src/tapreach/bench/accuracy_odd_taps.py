"""Regions when taps are not independent and normal, as real ones are not."""

from functools import partial

from tapreach.bench.accuracy_cells import CellResult, run_cell
from tapreach.bench.accuracy_outcomes import joined
from tapreach.bench.accuracy_plan import AccuracyPlan, Part
from tapreach.bench.accuracy_taps import (
    CORRELATION,
    TAIL,
    Taps,
    correlated,
    correlated_and_heavy_tailed,
    heavy_tailed,
)
from tapreach.bench.accuracy_trials import DEPTHS, VIEWS, Cell
from tapreach.bench.figure import Figure, at_least, at_most, known
from tapreach.bench.report import Section
from tapreach.bench.spread import spread

KINDS: dict[str, Taps] = {
    "correlated": correlated,
    "heavy-tailed": heavy_tailed,
    "both": correlated_and_heavy_tailed,
}


def measure_odd_taps(plan: AccuracyPlan) -> Section:
    """Run depths and views at 3 px and 1 % with each kind of tap."""
    cells = [Cell(depth, views, 3.0, 0.01) for depth in DEPTHS for views in VIEWS]
    figures: list[Figure] = []
    for kind, (name, taps) in enumerate(KINDS.items()):
        tasks = [(100 * kind + number, cell) for number, cell in enumerate(cells)]
        one = partial(run_cell, seed=plan.seed, part=Part.ODD_TAPS, trials=plan.trials, taps=taps)
        figures += _figures(name, spread(one, tasks, plan.jobs))
    return Section(
        "Taps that are correlated or heavy-tailed",
        f"As above at 3 px and 1 %, all depths and numbers of views. Correlated: {CORRELATION:g} from each "
        f"tap to the next. Heavy-tailed: Student's t, {TAIL:g} degrees of freedom. The standard deviation is "
        "the one that the estimator is told.",
        tuple(figures),
    )


def _figures(name: str, results: list[CellResult]) -> list[Figure]:
    figures = []
    for views in VIEWS:
        outcomes = joined([result.outcomes for result in results if result.cell.views == views])
        coverage = known(100.0 * outcomes.region_coverage())
        intervals = 100.0 * outcomes.interval_coverage()
        note = f"{int(outcomes.is_answered.sum())} answers; range interval {intervals:.1f} %"
        where = f"{name}, {views} views: 95 % region"
        figures += [
            Figure(f"{where}, at least", coverage, "%", at_least(92.0), note),
            Figure(f"{where}, at most", coverage, "%", at_most(97.0)),
        ]
    return figures
