"""Views that do not fit the others: found by how much the cost falls without them (docs/estimation.md, 8)."""

import math
from collections.abc import Collection

import numpy as np

from tapreach.estimation.map_solver import Solution, solve
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_FALSE_ALARMS = 0.01
_FEWEST_TO_BLAME = 4  # of three views, any two agree well enough without the third
_SLIP = 5.0  # one sigma of a slip, in sigmas of a tap: how likely each view is to show one is judged by this
_EQUALLY_SUSPECT = 2.0 * math.log(3.0)  # odds below three to one do not tell which of two views slipped
_TRIED = 3
_HOPE = 0.8  # share of the limit that the linear prediction must promise before a view is tried without


def solve_without_outliers(
    model: ViewModel, trusted: Collection[int] = ()
) -> tuple[ViewModel, Solution] | None:
    """Return the model with unfitting views left out and its solution.

    A view is left out where the cost falls beyond chance without it, 1 % false alarms in all, split between
    the views as equation (8b) says; the one that is nearly as likely to be the culprit goes with it. Three
    are always kept, and those `trusted`. None where no depth puts the target before all cameras.
    """
    solution = solve(model)
    while solution is not None and (spare := model.used - _FEWEST_TO_BLAME + 1) > 0:
        suspects = _suspects(model, solution, trusted)[: min(spare, 2)]
        if not suspects:
            break
        for view in suspects:
            model = model.without(view)
        solution = solve(model)
    return None if solution is None else (model, solution)


def _suspects(model: ViewModel, solution: Solution, trusted: Collection[int]) -> list[int]:
    """Return the views without which the cost falls beyond chance, most likely first, of like odds only."""
    expected, limits = _gains_and_limits(model, solution)
    excess: dict[int, float] = {}
    for view in np.argsort(limits - expected)[:_TRIED].tolist():
        if view in trusted or expected[view] < _HOPE * limits[view]:
            continue
        found = solve(model.without(view))
        if found is not None and solution.cost - found.cost >= limits[view]:
            excess[view] = solution.cost - found.cost - limits[view]
    least = max(excess.values(), default=0.0) - _EQUALLY_SUSPECT
    return sorted((view for view in excess if excess[view] >= least), key=lambda view: -excess[view])


def _gains_and_limits(model: ViewModel, solution: Solution) -> tuple[FloatArray, FloatArray]:
    """Return (n,) each: the linear prediction (8a) of how much the cost falls without each view, and by how
    much it must fall, (8b).

    I − P = C⁻¹ − C⁻¹ Jt S⁻¹ Jtᵀ C⁻¹, of which the diagonal blocks are needed; C⁻¹ = Gᵀ G.
    """
    views = solution.views
    residuals, pull, unfactored = views.residuals[0], views.pull, views.unfactored
    damped = solution.on_target + 1e-12 * np.diag(solution.on_target.diagonal())
    if model.whitening is not None:  # a slip shifts one tap, and so what is expected of the next
        residuals, pull = model.whitening.T @ residuals, model.whitening.T @ pull
        unfactored = unfactored @ model.whitening
    by_view = unfactored.T.reshape(model.views, 2, -1)
    solved = np.linalg.solve(damped, pull.T).T.reshape(model.views, 2, 3)
    blocks = by_view @ by_view.mT - pull.reshape(model.views, 2, 3) @ solved.mT
    uu, uv, vv = blocks[:, 0, 0] + 1e-9, blocks[:, 0, 1], blocks[:, 1, 1] + 1e-9
    u, v = residuals[0::2], residuals[1::2]
    determinants = np.maximum(uu * vv - uv * uv, 1e-18)
    gains = (vv * u * u - 2.0 * uv * u * v + uu * v * v) / determinants
    seen = _SLIP**-2
    shares = model.is_used / np.sqrt((uu + seen) * (vv + seen) - uv * uv)
    with np.errstate(divide="ignore"):
        limits = -2.0 * np.log(_FALSE_ALARMS * shares / np.sum(shares))
    return np.where(model.is_used, gains, 0.0), limits
