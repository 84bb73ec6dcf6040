"""Plain Gauss-Newton for one point, as most sets of views need no more; it says so where they do."""

import numpy as np
from scipy.linalg.lapack import dposv

from tapreach.estimation.linearised import Linearised
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_ITERATIONS = 8
_NEAR = 1e-4  # of the squared residuals still to gain: 0.01 sigma, over which the derivatives do not change
_REACHED = 1e-6


def settled(model: ViewModel, start: FloatArray) -> Linearised | None:
    """Return the minimum of (6) reached from `start` (3 + k,) by full steps, all of which lower the cost.

    The last step is so short that the views keep the derivatives from before it. None where a step raises the
    cost or puts the target behind a camera, or where they do not come to an end: then it takes
    `gauss_newton.descended`.
    """
    now = model.linearised(start[None])
    before = 0.0
    for _ in range(_ITERATIONS):
        if not now.is_in_front[0]:
            return None
        step, promised = _step(now)
        # The promise shrinks at least as fast again as it did.
        if promised < _NEAR and promised * (promised / before if promised < before else 1.0) < _REACHED:
            return now.moved(step)
        after = model.linearised(now.x + step)
        if not after.costs[0] <= now.costs[0] * (1.0 + 1e-12) + 1e-15:
            return None
        now, before = after, promised
    return None


def _step(now: Linearised) -> tuple[FloatArray, float]:
    """Return the step (3 + k,) to the minimum of the linearised problem and the fall of the cost there.

    With e = r − Jz z and w = C⁻¹ (e + Jt dt), Jtᵀ w = 0: dz = −Jzᵀ w − z, and eᵀ w remains of the cost.
    """
    by_errors, normals = now.by_errors[0], now.x[0, 3:]
    rows, solved = now.weighed_rows
    products = rows.T @ solved
    _, on_target, failed = dposv(products[:3, :3], -products[:3, 3])
    if failed:
        return np.zeros(now.x.shape[1]), np.inf
    weighted = solved[:, :3] @ on_target + solved[:, 3]
    step = np.concatenate([on_target, -(weighted @ by_errors) - normals])
    remains = products[3, 3] + products[3, :3] @ on_target
    return step, max(float(now.costs[0] - remains), 0.0)  # below zero it is rounding
