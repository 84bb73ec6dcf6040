"""Gauss-Newton with Levenberg's damping for many points at once, pose errors eliminated in every step."""

import numpy as np

from tapreach.estimation.linearised import Linearised
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_ITERATIONS = 60
_LEAST_DAMPING = 1e-12  # keeps an unknown about which nothing is known where it is
_FIRST_DAMPING = 1e-5  # after a refused step; below it a smaller one is none
_LONGEST = 1e6  # of a step in any unknown; nothing real is that far, and longer ones end in overflow


def descended(
    model: ViewModel, starts: FloatArray, *, is_depth_free: bool = True, tolerance: float = 1e-16
) -> Linearised:
    """Return the minima of (6) reached from starts (m, 3 + k), over all unknowns or all but rho.

    A point rests when its next step would lower the cost by less than `tolerance` (of the cost, where that is
    above 1), judged by the rate at which its steps shrink. Steps that put the target behind a camera
    are refused like steps that raise the cost; a start that is behind one stays there, at infinite cost.
    """
    free = 3 if is_depth_free else 2
    reached = model.linearised(starts)
    moving = np.flatnonzero(reached.is_in_front)
    now = reached.take(moving)
    damping, before = np.zeros(len(moving)), np.zeros(len(moving))
    for _ in range(_ITERATIONS if len(moving) else 0):
        steps, promised = _damped_steps(now, free, damping)
        after, costs = model.linearised(now.x + steps), now.costs
        is_better = after.costs <= costs * (1.0 + 1e-14)
        rate = np.where(is_better, promised / np.maximum(np.maximum(promised, before), 1e-300), 1.0)
        rests = promised * rate < tolerance * np.maximum(1.0, costs)
        now = after if is_better.all() else now.updated(after, is_better)
        damping = np.where(is_better, _lowered(damping), np.maximum(10.0 * damping, _FIRST_DAMPING))
        before = promised
        if rests.all():
            return reached.replaced(moving, now)
        if rests.any():
            reached = reached.replaced(moving[rests], now.take(rests))
            moving, now, damping, before = moving[~rests], now.take(~rests), damping[~rests], before[~rests]
    return reached.replaced(moving, now)


def _damped_steps(now: Linearised, free: int, damping: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return steps (m, 3 + k) over the first `free` of (a, b, rho) and all of z, and the fall they promise.

    With w = C⁻¹ (r − Jz z/p + Jt dt), p = 1 + damping, the pose errors' step is dz = −(Jzᵀ w + z)/p.
    """
    by_target, normals = now.by_target[..., :free], now.x[:, 3:]
    inverse = (1.0 / (1.0 + damping))[:, None]
    expected = now.residuals - inverse * _times(now.by_errors, normals)
    solved = now.solved(np.concatenate([by_target, expected[..., None]], axis=2), damping)
    across = np.swapaxes(by_target, 1, 2)
    information, pull = across @ solved[..., :free], across @ solved[..., free:]
    every = np.arange(free)
    known = np.sum(by_target * by_target, axis=1)
    floor = (damping[:, None] + _LEAST_DAMPING) * known
    information[:, every, every] += np.where(known > 0.0, floor, 1.0)
    on_target = -np.linalg.solve(information, pull)
    weighted = (solved[..., free:] + solved[..., :free] @ on_target)[..., 0]
    steps = np.zeros_like(now.x)
    steps[:, :free] = on_target[..., 0]
    steps[:, 3:] = -inverse * (_times(np.swapaxes(now.by_errors, 1, 2), weighted) + normals)
    moved = _times(by_target, steps[:, :free]) + _times(now.by_errors, steps[:, 3:])
    promised = -np.sum(now.residuals * moved, axis=1) - np.sum(normals * steps[:, 3:], axis=1)
    shortened = 1.0 / np.maximum(1.0, np.abs(steps).max(axis=1) / _LONGEST)
    return shortened[:, None] * steps, promised


def _lowered(damping: FloatArray) -> FloatArray:
    lower = 0.1 * damping
    return np.where(lower < _FIRST_DAMPING, 0.0, lower)


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    return np.asarray((matrices @ vectors[..., None])[..., 0])
