"""Random motions, a fifth of them singular: what is said of them, and whether anything breaks."""

import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial

import numpy as np

from tapreach.bench.accuracy_intervals import interval_figures
from tapreach.bench.accuracy_outcomes import Outcomes, joined, score
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_trials import Trials
from tapreach.bench.accuracy_wandering import (
    FARTHEST,
    NEAREST,
    SINGULAR,
    Motion,
    draw_motions,
    hardly_moving,
    tapped_anywhere,
    wandering,
)
from tapreach.bench.figure import Figure, at_least, exactly
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.estimation.range_posterior import RangePrior

TASKS = 200
"""Each has its own kind of motion, number of views, sigma and odometry."""
FLAGGED = {Status.DEGENERATE, Status.BEHIND, Status.INCONSISTENT}


class Kind(StrEnum):
    """What the trials of a task are."""

    WANDERING = "wandering"
    TOLD = "told the ranges"
    ANYWHERE = "tapped anywhere"
    TINY = "hardly moving"
    SINGULAR = "singular"


_TURNS = (
    *[Kind.WANDERING] * 9,
    *[Kind.TOLD] * 4,
    Kind.ANYWHERE,
    *[Kind.TINY] * 2,
    *[Kind.SINGULAR] * 4,
)
"""The kinds of twenty tasks in a row."""


@dataclass
class MotionResult:
    """What was said of the motions of one task."""

    kind: Kind
    statuses: Counter[str] = field(default_factory=Counter)
    exceptions: list[str] = field(default_factory=list)
    behind: int = 0
    outcomes: list[Outcomes] = field(default_factory=list)


def measure_motions(plan: AccuracyPlan) -> Section:
    """Run random motions of every kind."""
    one = partial(_run, seed=plan.seed, trials=max(1, plan.motions // TASKS))
    results = spread(one, range(min(TASKS, plan.motions)), plan.jobs)
    return Section(
        "Random motions",
        "2 to 6 views, turns to 29°, advances to 50 cm either way, targets anywhere in the picture at 0.2 to "
        "10 m, even odds over the logarithm, taps of 1 to 3 px, odometry of 1 to 3 %. Of twenty motions four "
        "are singular: standing, turning about the camera's own centre, or driving straight along the line "
        "of sight; two move by less than a micrometre; in one the taps have nothing to do with each other. "
        "Flagged: degenerate, behind or inconsistent, so that no range is given. Intervals: of the others, "
        "nine with the estimator's own prior, even odds over the inverse range from 5 cm on, which is not "
        "how the targets were drawn; four told how they were.",
        (
            *_safety_figures(results),
            *_interval_figures(results, Kind.WANDERING),
            *_interval_figures(results, Kind.TOLD),
        ),
    )


def _run(task: int, seed: int, trials: int) -> MotionResult:
    random = generator(seed, Part.MOTIONS, task)
    kind = _TURNS[task % len(_TURNS)]
    views = int(random.integers(2, 7))
    pixel_sigma, odometry = random.uniform(1.0, 3.0), random.uniform(0.01, 0.03)
    drawn = draw_motions(_motion(kind, task), trials, views, pixel_sigma, odometry, random)
    if kind is Kind.ANYWHERE:
        drawn = tapped_anywhere(drawn, random)
    prior = RangePrior(NEAREST, FARTHEST, falloff=0.0) if kind is Kind.TOLD else None
    motion = OdometryNoise.per_step(odometry)
    estimate = partial(estimate_point, motion=motion, range_prior=prior, with_advice=False)
    return _judge(drawn, estimate, MotionResult(kind))


def _motion(kind: Kind, task: int) -> Motion:
    if kind is Kind.SINGULAR:
        kinds = list(SINGULAR.values())
        return kinds[(task // len(_TURNS) + task) % len(kinds)]
    return hardly_moving if kind is Kind.TINY else wandering


def _judge(
    drawn: Trials, ask: Callable[[list[Observation]], PointEstimate], result: MotionResult
) -> MotionResult:
    estimates: list[PointEstimate] = []
    kept: list[int] = []
    for number, observations in enumerate(drawn.sightings()):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                estimate = ask(observations)
        except Exception as error:  # whatever it is, warnings too, it is what this counts
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
    cameras = [view.world_from_base.as_matrix() @ view.base_from_camera.as_matrix() for view in used]
    return any(camera[:3, 2] @ (estimate.point_in_world - camera[:3, 3]) <= 0.0 for camera in cameras)


def _safety_figures(results: list[MotionResult]) -> tuple[Figure, ...]:
    statuses = {kind: sum((r.statuses for r in results if r.kind is kind), Counter[str]()) for kind in Kind}
    singular, tiny = statuses[Kind.SINGULAR], statuses[Kind.TINY]
    flagged = sum(singular[status] for status in FLAGGED)
    exceptions = [text for result in results for text in result.exceptions]
    total = sum(each.total() for each in statuses.values()) + len(exceptions)
    of_wandering, of_singular, of_tiny, of_anywhere = (
        _by_status(statuses[kind]) for kind in (Kind.WANDERING, Kind.SINGULAR, Kind.TINY, Kind.ANYWHERE)
    )
    share = 100.0 * flagged / max(singular.total(), 1)
    behind = sum(result.behind for result in results)
    return (
        Figure("motions", total, "", None, f"wandering: {of_wandering}"),
        Figure("singular: flagged", share, "%", at_least(100.0), of_singular),
        Figure("singular: given two ends", singular[Status.DETERMINED], "", exactly(0)),
        Figure(
            "hardly moving: given a range with two ends", tiny[Status.DETERMINED], "", exactly(0), of_tiny
        ),
        Figure("answers behind a camera", behind, "", exactly(0), f"tapped anywhere: {of_anywhere}"),
        Figure("exceptions and warnings", len(exceptions), "", exactly(0), "; ".join(exceptions[:1])),
    )


def _by_status(statuses: Counter[str]) -> str:
    return ", ".join(f"{count} {str(status).replace('_', ' ')}" for status, count in statuses.most_common())


def _interval_figures(results: list[MotionResult], kind: Kind) -> tuple[Figure, ...]:
    parts = [part for result in results if result.kind is kind for part in result.outcomes]
    if not parts:
        return ()
    return tuple(replace(figure, name=f"{kind}: {figure.name}") for figure in interval_figures(joined(parts)))
