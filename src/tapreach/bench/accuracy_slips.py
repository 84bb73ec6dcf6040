"""One tap of five that slipped: is it found, and is the answer without it as good as it can be."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_cells import experiment_of
from tapreach.bench.accuracy_outcomes import Outcomes, estimate_all
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_scene import onto_picture
from tapreach.bench.accuracy_trials import DEPTHS, Cell, Trials, draw_trials
from tapreach.bench.figure import Figure, Limit, at_least, at_most
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.geometry.finite import FloatArray

SLIP_PX, SIGMA_PX, VIEWS = 20.0, 3.0, 5
TIMES = 8
"""Trials at each depth for one in a setting: an alarm in a hundred needs many to be told from two."""


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
    trials = plan.trials * TIMES
    results = spread(partial(_run, seed=plan.seed, trials=trials), tasks, plan.jobs)
    return Section(
        "One slipped tap among five",
        f"A tap at any one of the {VIEWS} views is off by {SLIP_PX:g} px more, in any direction, at "
        f"{SIGMA_PX:g} px and 1 %; {trials} trials at each of {len(DEPTHS)} depths, and the same trials "
        "without the slip for the false alarms. Error over bound: of the answers without the slipped view, "
        "against the bound without it. The table has found / error over bound by the view that slipped.",
        _figures(results),
        _grid(results),
    )


def _run(task: tuple[int, Cell], seed: int, trials: int) -> SlipResult:
    number, cell = task
    random = generator(seed, Part.SLIPS, number)
    clean = draw_trials(cell, trials, random)
    views = random.integers(VIEWS, size=trials)
    slipped = slip(clean, views, random.uniform(0.0, 2.0 * np.pi, size=trials))
    bounds = np.array([experiment_of(cell, clean, view).inverse_depth_sd for view in range(VIEWS)])
    return SlipResult(estimate_all(clean, cell.noise), estimate_all(slipped, cell.noise), views, bounds)


def slip(trials: Trials, views: npt.NDArray[np.int64], directions: FloatArray) -> Trials:
    """Return the trials with one view (m,) of each moved by 20 px in a direction (m,) [rad]."""
    pixels = trials.pixels.copy()
    offsets = SLIP_PX * np.stack([np.cos(directions), np.sin(directions)], axis=1)
    pixels[np.arange(len(pixels)), views] += offsets
    return replace(trials, pixels=onto_picture(pixels))


def _figures(results: list[SlipResult]) -> tuple[Figure, ...]:
    found = np.concatenate([result.is_found for result in results])
    alarms = np.concatenate([np.any(result.clean.rejected, axis=1) for result in results])
    shares = [float(alarms.mean()), float(found.mean())]
    chances = [100.0 * float(np.sqrt(share * (1.0 - share) / len(found))) for share in shares]
    errors = _errors_over_bound(results)
    in_last = _errors_over_bound(results, VIEWS - 1)
    return (
        Figure(
            "slip found", 100.0 * shares[1], "%", at_least(95.0), f"± {chances[1]:.2f}; {len(found)} trials"
        ),
        Figure("false alarms without a slip", 100.0 * shares[0], "%", at_most(1.0), f"± {chances[0]:.2f}"),
        Figure("error over bound without the slipped view", *_root_mean_square(errors)),
        Figure("the same where the last view slipped", *_root_mean_square(in_last)),
    )


def _errors_over_bound(results: list[SlipResult], view: int | None = None) -> FloatArray:
    """Return the errors of 1/Z over the bound where the slip was found, of one view or of any."""
    errors = []
    for result in results:
        kept = result.is_found & result.slipped.is_answered
        kept &= (result.views == view) if view is not None else True
        errors.append(result.slipped.errors[kept, 2] / result.bounds[result.views[kept]])
    return np.concatenate(errors)


def _root_mean_square(errors: FloatArray) -> tuple[float | None, str, Limit, str]:
    if not len(errors):
        return None, "", at_most(1.1), "none was found"
    root = float(np.sqrt(np.mean(errors**2)))
    return root, "", at_most(1.1), f"± {float(np.std(errors**2)) / np.sqrt(len(errors)) / (2.0 * root):.2g}"


def _grid(results: list[SlipResult]) -> Grid:
    rows = []
    for depth, result in zip(DEPTHS, results, strict=True):
        cells = []
        for view in range(VIEWS):
            found = result.is_found[result.views == view]
            error = _root_mean_square(_errors_over_bound([result], view))[0]
            share = f"{100.0 * found.mean():.1f} %" if len(found) else "—"
            cells.append(f"{share} / {'—' if error is None else f'{error:.2f}'}")
        rows.append((f"{depth:g} m", *cells))
    return Grid(("depth", *(f"view {view + 1}" for view in range(VIEWS))), tuple(rows))
