"""Regions when taps are not independent and normal, as real ones are not."""

import math
from functools import partial

from tapreach.bench.accuracy_outcomes import Outcomes, estimate_all, joined
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_taps import (
    CORRELATION,
    TAIL,
    Taps,
    correlated,
    correlated_and_heavy_tailed,
    heavy_tailed,
)
from tapreach.bench.accuracy_trials import DEPTHS, VIEWS, Cell, draw_trials
from tapreach.bench.figure import Figure, known, within
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.estimation.tap_noise import TapNoise

IN_SEQUENCE = TapNoise(correlation=CORRELATION)
KINDS: dict[str, tuple[Taps, TapNoise | None]] = {
    "correlated": (correlated, IN_SEQUENCE),
    "heavy-tailed": (heavy_tailed, None),
    "both": (correlated_and_heavy_tailed, IN_SEQUENCE),
}
"""How the taps err, and what the estimator is told of it."""


TIMES = 3
"""Trials of each kind for one in a setting: nothing is known here that would take chance away."""

Task = tuple[int, Cell, str]


def measure_odd_taps(plan: AccuracyPlan) -> Section:
    """Run depths and views at 3 px and 1 % with each kind of tap."""
    cells = [Cell(depth, views, 3.0, 0.01) for depth in DEPTHS for views in VIEWS]
    tasks = [
        (100 * kind + number, cell, name)
        for kind, name in enumerate(KINDS)
        for number, cell in enumerate(cells)
    ]
    trials = plan.trials * TIMES
    found = spread(partial(_run, seed=plan.seed, trials=trials), tasks, plan.jobs)
    results = list(zip(tasks, found, strict=True))
    return Section(
        "Taps that are correlated or heavy-tailed",
        f"As above at 3 px and 1 %, {trials} trials at each depth and number of views. Correlated: "
        f"{CORRELATION:g} from each tap to the next. Heavy-tailed: Student's t, {TAIL:g} degrees of freedom. "
        "The estimator is told the standard deviation and the correlation where there is one, and nothing of "
        "the tails.",
        tuple(_figure(name, views, results) for name in KINDS for views in VIEWS),
    )


def _run(task: Task, seed: int, trials: int) -> Outcomes:
    number, cell, kind = task
    taps, told = KINDS[kind]
    drawn = draw_trials(cell, trials, generator(seed, Part.ODD_TAPS, number), taps)
    return estimate_all(drawn, cell.noise, told)


def _figure(name: str, views: int, results: list[tuple[Task, Outcomes]]) -> Figure:
    outcomes = joined([found for (_, cell, kind), found in results if kind == name and cell.views == views])
    count = int(outcomes.is_answered.sum())
    chance = 100.0 * math.sqrt(0.95 * 0.05 / max(count, 1))
    note = f"± {chance:.1g}; {count} answers; range interval {100.0 * outcomes.interval_coverage():.1f} %"
    coverage = known(100.0 * outcomes.region_coverage())
    return Figure(f"{name}, {views} views: 95 % region", coverage, "%", within(92.0, 97.0), note)
