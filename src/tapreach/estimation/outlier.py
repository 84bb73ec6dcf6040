"""Views that do not fit the others: found by how much the cost falls without them (docs/estimation.md, 8)."""

import numpy as np

from tapreach.estimation.map_solver import Solution, solve
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import chi2_limit

_FALSE_ALARMS = 0.01
_FEWEST_TO_BLAME = 4  # of three views, any two agree well enough without the third
_TRIED = 3
_HOPE = 0.8  # share of the limit that the linear prediction must promise before a view is tried without


def solve_without_outliers(model: ViewModel) -> tuple[ViewModel, Solution] | None:
    """Return the model with unfitting views left out, one by one, and its solution.

    A view is left out where the cost falls beyond chance without it: the best of n is tested at 1 % false
    alarms in all. Three are always kept. None where no depth puts the target before all cameras.
    """
    solution = solve(model)
    while solution is not None and int(model.is_used.sum()) >= _FEWEST_TO_BLAME:
        limit = chi2_limit(1.0 - _FALSE_ALARMS / int(model.is_used.sum()), 2)
        better = _best_without_one(model, solution, _HOPE * limit)
        if better is None or solution.cost - better[1].cost < limit:
            break
        model, solution = better
    return None if solution is None else (model, solution)


def _best_without_one(
    model: ViewModel, solution: Solution, hoped: float
) -> tuple[ViewModel, Solution] | None:
    expected = _expected_gains(solution, model.whitening)
    best: tuple[ViewModel, Solution] | None = None
    for view in np.argsort(expected)[::-1][:_TRIED]:
        if expected[view] < hoped:
            break
        reduced = model.without(int(view))
        found = solve(reduced)
        if found is not None and (best is None or found.cost < best[1].cost):
            best = reduced, found
    return best


def _expected_gains(solution: Solution, whitening: FloatArray | None) -> FloatArray:
    """Return (n,): the linear prediction of how much the cost falls without each view.

    I − P = C⁻¹ − C⁻¹ Jt S⁻¹ Jtᵀ C⁻¹, of which the diagonal blocks are needed.
    """
    views = solution.views
    residuals = views.residuals[0]
    precision = views.solved(np.eye(len(residuals))[None])[0]
    pull = precision @ views.by_target[0]
    damped = solution.on_target + 1e-12 * np.diag(np.diag(views.by_target[0].T @ views.by_target[0]))
    remaining = precision - pull @ np.linalg.solve(damped, pull.T)
    if whitening is not None:  # a slip shifts one tap, and so what is expected of the next
        remaining, residuals = whitening.T @ remaining @ whitening, whitening.T @ residuals
    remaining = remaining.reshape(-1, 2, len(residuals) // 2, 2)
    every = np.arange(len(remaining))
    blocks = remaining[every, :, every] + 1e-9 * np.eye(2)
    pairs = residuals.reshape(-1, 2)
    return np.asarray(np.sum(pairs * np.linalg.solve(blocks, pairs[:, :, None])[:, :, 0], axis=1))
