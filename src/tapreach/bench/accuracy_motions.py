"""Random motions, a fifth of them singular: what is said of them, and whether anything breaks."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from tapreach.bench.accuracy_intervals import interval_figures
from tapreach.bench.accuracy_outcomes import Outcomes, joined, score
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_trials import Trials
from tapreach.bench.accuracy_wandering import FARTHEST, NEAREST, SINGULAR, draw_motions, wandering
from tapreach.bench.figure import Figure, at_least, exactly
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.estimation.range_posterior import RangePrior

TASKS = 60
"""Each has its own number of views, sigma and odometry."""
FLAGGED = {Status.DEGENERATE, Status.BEHIND, Status.INCONSISTENT}


@dataclass
class MotionResult:
    """What was said of the motions of one task; is_told: which ranges the targets were drawn from."""

    is_singular: bool
    is_told: bool
    statuses: Counter[str] = field(default_factory=Counter)
    exceptions: list[str] = field(default_factory=list)
    behind: int = 0
    outcomes: list[Outcomes] = field(default_factory=list)


def measure_motions(plan: AccuracyPlan) -> Section:
    """Run random motions, four of five tasks wandering and one singular."""
    one = partial(_run, seed=plan.seed, trials=max(1, plan.motions // TASKS))
    results = [result for pair in spread(one, range(TASKS), plan.jobs) for result in pair]
    return Section(
        "Random motions",
        "2 to 6 views, turns to 29°, advances to 50 cm either way, targets anywhere in the picture at 0.2 to "
        "10 m, taps of 1 to 3 px, odometry of 1 to 3 %. Every fifth motion is singular: standing, turning "
        "about the camera's own centre, or driving straight along the line of sight. Flagged: degenerate, "
        "behind or inconsistent, so that no range is given. Intervals: of the motions that are "
        "not singular, once with the estimator's own prior over ranges (0.05 to 100 m), once told the one "
        "that the targets were drawn from.",
        (*_safety_figures(results), *_interval_figures(results, False), *_interval_figures(results, True)),
    )


def _run(task: int, seed: int, trials: int) -> list[MotionResult]:
    random = generator(seed, Part.MOTIONS, task)
    kinds = list(SINGULAR.values())
    is_singular = task % 5 == 4
    kind = kinds[task // 5 % len(kinds)] if is_singular else wandering
    views = int(random.integers(2, 7))
    pixel_sigma, odometry = random.uniform(1.0, 3.0), random.uniform(0.01, 0.03)
    drawn = draw_motions(kind, trials, views, pixel_sigma, odometry, random)
    estimate = partial(estimate_point, motion=OdometryNoise.per_step(odometry), with_advice=False)
    told = partial(estimate, range_prior=RangePrior(NEAREST, FARTHEST))
    results = [_judge(drawn, estimate, MotionResult(is_singular, is_told=False))]
    if not is_singular:
        results.append(_judge(drawn, told, MotionResult(is_singular, is_told=True)))
    return results


def _judge(
    drawn: Trials, ask: Callable[[list[Observation]], PointEstimate], result: MotionResult
) -> MotionResult:
    estimates: list[PointEstimate] = []
    kept: list[int] = []
    for number, observations in enumerate(drawn.sightings()):
        try:
            estimate = ask(observations)
        except Exception as error:  # whatever it is, it is what this counts
            result.exceptions.append(f"{type(error).__name__}: {error}")
            continue
        result.statuses[estimate.status] += 1
        result.behind += is_behind(estimate, observations)
        estimates.append(estimate)
        kept.append(number)
    result.outcomes.append(score(drawn.chosen(np.array(kept, dtype=int)), estimates))
    return result


def is_behind(estimate: PointEstimate, observations: Sequence[Observation]) -> bool:
    """Tell whether a point was given that lies behind a camera whose view was used, or a range below zero."""
    if estimate.range_interval_95 is not None and estimate.range_interval_95[0] <= 0.0:
        return True
    if estimate.point_in_world is None:
        return False
    used = [view for i, view in enumerate(observations) if i not in estimate.rejected_views]
    depths = [view.world_from_camera.inv().apply(estimate.point_in_world)[2] for view in used]
    return bool(min(depths) <= 0.0)


def _safety_figures(results: list[MotionResult]) -> tuple[Figure, ...]:
    singular = sum((r.statuses for r in results if r.is_singular), Counter[str]())
    others = sum((r.statuses for r in results if not r.is_singular and not r.is_told), Counter[str]())
    flagged = sum(singular[status] for status in FLAGGED)
    exceptions = [text for result in results for text in result.exceptions]
    total = singular.total() + others.total() + sum(len(r.exceptions) for r in results if not r.is_told)
    return (
        Figure("motions", total, "", None, _by_status(others) + " where not singular"),
        Figure(
            "singular: flagged",
            100.0 * flagged / max(singular.total(), 1),
            "%",
            at_least(100.0),
            f"of {singular.total()}: {_by_status(singular)}",
        ),
        Figure("singular: given a range with two ends", singular[Status.DETERMINED], "", exactly(0)),
        Figure("answers behind a camera", sum(r.behind for r in results), "", exactly(0)),
        Figure("exceptions", len(exceptions), "", exactly(0), exceptions[0] if exceptions else ""),
    )


def _by_status(statuses: Counter[str]) -> str:
    return ", ".join(f"{count} {str(status).replace('_', ' ')}" for status, count in statuses.most_common())


def _interval_figures(results: list[MotionResult], is_told: bool) -> tuple[Figure, ...]:
    chosen = [r for r in results if not r.is_singular and r.is_told == is_told]
    figures = interval_figures(joined([part for result in chosen for part in result.outcomes]))
    prefix = "told the ranges: " if is_told else ""
    return tuple(replace(figure, name=prefix + figure.name) for figure in figures)
