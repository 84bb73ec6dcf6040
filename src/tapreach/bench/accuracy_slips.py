"""One tap of five that slipped: is it found, and is the answer without it as good as it can be."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_cells import bound_of
from tapreach.bench.accuracy_outcomes import Outcomes, estimate_all
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_scene import onto_picture
from tapreach.bench.accuracy_trials import DEPTHS, Cell, Trials, draw_trials
from tapreach.bench.figure import Figure, at_least, at_most, known
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.geometry.finite import FloatArray

SLIP_PX, SIGMA_PX, VIEWS = 20.0, 3.0, 5
_UNSEEN_PX = 1e9
"""The sigma of a view that says nothing."""


@dataclass(frozen=True)
class SlipResult:
    """clean, slipped: the same trials before and after. views (m,): the one that slipped. bounds (n,) [1/m]:
    on the inverse depth without each view.
    """

    clean: Outcomes
    slipped: Outcomes
    views: npt.NDArray[np.int64]
    bounds: FloatArray

    @property
    def is_found(self) -> npt.NDArray[np.bool_]:
        """(m,) True where the view that slipped was left out."""
        return np.asarray(self.slipped.rejected[np.arange(len(self.views)), self.views])


def measure_slips(plan: AccuracyPlan) -> Section:
    """Run every depth with and without a slip."""
    tasks = [(number, Cell(depth, VIEWS, SIGMA_PX, 0.01)) for number, depth in enumerate(DEPTHS)]
    one = partial(_run, seed=plan.seed, trials=plan.trials)
    results = spread(one, tasks, plan.jobs)
    return Section(
        "One slipped tap among five",
        f"A tap at any one of the {VIEWS} views is off by {SLIP_PX:g} px more, in any direction, at "
        f"{SIGMA_PX:g} px and 1 %; {plan.trials} trials at each of {len(DEPTHS)} depths, and the same trials "
        "without the slip for the false alarms. Error over bound: of the answers without the slipped view.",
        _figures(results),
    )


def _run(task: tuple[int, Cell], seed: int, trials: int) -> SlipResult:
    number, cell = task
    random = generator(seed, Part.SLIPS, number)
    clean = draw_trials(cell, trials, random)
    views = random.integers(VIEWS, size=trials)
    slipped = slip(clean, views, random.uniform(0.0, 2.0 * np.pi, size=trials))
    bounds = np.array([_bound_without(view, cell, clean) for view in range(VIEWS)])
    return SlipResult(estimate_all(clean, cell.noise), estimate_all(slipped, cell.noise), views, bounds)


def slip(trials: Trials, views: npt.NDArray[np.int64], directions: FloatArray) -> Trials:
    """Return the trials with one view (m,) of each moved by 20 px in a direction (m,) [rad]."""
    pixels = trials.pixels.copy()
    offsets = SLIP_PX * np.stack([np.cos(directions), np.sin(directions)], axis=1)
    pixels[np.arange(len(pixels)), views] += offsets
    return replace(trials, pixels=onto_picture(pixels))


def _bound_without(view: int, cell: Cell, trials: Trials) -> float:
    observations = next(trials.sightings())
    observations[view] = replace(observations[view], pixel_sigma=_UNSEEN_PX)
    return bound_of(cell, observations, trials)


def _figures(results: list[SlipResult]) -> tuple[Figure, ...]:
    found = np.concatenate([result.is_found for result in results])
    alarms = np.concatenate([np.any(result.clean.rejected, axis=1) for result in results])
    chance = 100.0 * float(np.sqrt(0.01 * 0.99 / len(alarms)))
    return (
        Figure("slip found", 100.0 * float(found.mean()), "%", at_least(95.0), _by(results, _found_percent)),
        Figure(
            "false alarms without a slip",
            100.0 * float(alarms.mean()),
            "%",
            at_most(1.0),
            f"{len(alarms)} trials; standard error {chance:.2f} %",
        ),
        Figure(
            "error over bound without the slipped view",
            known(_error_over_bound(results)),
            "",
            at_most(1.1),
            _by(results, lambda result: _error_over_bound([result])),
        ),
    )


def _found_percent(result: SlipResult) -> float:
    return 100.0 * float(result.is_found.mean())


def _error_over_bound(results: list[SlipResult]) -> float:
    ratios = []
    for result in results:
        kept = result.is_found & result.slipped.is_answered
        ratios.append(result.slipped.errors[kept, 2] / result.bounds[result.views[kept]])
    every = np.concatenate(ratios)
    return float(np.sqrt(np.mean(every**2))) if len(every) else float("nan")


def _by(results: list[SlipResult], value: Callable[[SlipResult], float]) -> str:
    at = [f"{value(result):.3g} at {depth:g} m" for depth, result in zip(DEPTHS, results, strict=True)]
    return ", ".join(at)
