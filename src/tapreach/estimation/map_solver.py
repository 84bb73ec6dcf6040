"""The most probable target and pose errors, from several depths (docs/estimation.md, 5 and 6)."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dposv

from tapreach.estimation.gauss_newton import descended
from tapreach.estimation.gauss_newton_plain import settled
from tapreach.estimation.linearised import Linearised
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

# Inverse depths to start from, in units of 1 over the baseline.
_STARTS = np.array([0.0, 0.01, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6, 1.0, 2.0, 4.0])

_IDENTITY = np.eye(3)
_SHORT_BASELINE = 1e-6  # [m]; cameras nearer to each other than this show the same
_CLEAR = 3.0  # sigmas from infinity, and of the squared residuals above their mean


@dataclass(frozen=True)
class Solution:
    """x (3 + k,) at the minimum of (6) and its cost, the views linearised there, and the information (3, 3)
    on (a, b, rho), equation (7).
    """

    x: FloatArray
    cost: float
    views: Linearised
    on_target: FloatArray

    @property
    def inverse_depth(self) -> float:
        """rho = 1/Z in the first camera [1/m]; below zero when the rays diverge."""
        return float(self.x[2])


def solve(model: ViewModel) -> Solution | None:
    """Return the best minimum over several starts in depth; None where no depth has it before all cameras,
    and where the cameras used have all stood in one place.

    Where the lines of sight nearly meet well before infinity there is but one, found at once.
    """
    if model.baseline < _SHORT_BASELINE:
        return None
    near = _at_crossing(model)
    if near is not None:
        return near
    starts = _valleys(model)
    if len(starts) == 0:
        return None
    found = descended(model, starts)
    best = int(np.argmin(found.costs))
    if not np.isfinite(found.costs[best]):
        return None
    views = found.take(np.array([best])) if len(starts) > 1 else found
    return Solution(views.x[0], float(views.costs[0]), views, views.on_target()[0])


def _at_crossing(model: ViewModel) -> Solution | None:
    """Return the minimum next to where the lines of sight nearly meet, where it is beyond doubt the best."""
    start = model.triangulated()
    views = settled(model, start) if start is not None and start[2] > 0.0 else None
    if views is None:
        return None
    freedom = max(2 * model.used - 3, 1)
    on_target, rho, cost = views.on_target()[0], float(views.x[0, 2]), float(views.costs[0])
    is_clear = rho > 0.0 and inverse_depth_information(on_target) * rho * rho > _CLEAR**2
    if not is_clear or cost > freedom + _CLEAR * math.sqrt(2.0 * freedom):
        return None
    return Solution(views.x[0], cost, views, on_target)


def covariance_of(information: FloatArray) -> FloatArray:
    """Return the inverse; scaled first, as the unknowns of a near target differ by many powers of ten."""
    scale = 1.0 / np.sqrt(information.diagonal())
    scaling = scale[:, None] * scale
    _, inverse, failed = dposv(information * scaling, _IDENTITY)
    if failed:  # rounding has made it indefinite
        inverse = np.linalg.inv(information * scaling)
    return np.asarray(inverse * scaling, dtype=np.float64)


def inverse_depth_information(on_target: FloatArray) -> float:
    """Return the information [m²] on rho alone, bearing marginalised; 0 or a rounding error when singular."""
    (aa, ab, ac), (_, bb, bc), (_, _, cc) = on_target.tolist()
    determinant = aa * bb - ab * ab
    if not determinant > 1e-14 * aa * bb:
        return 0.0  # not even the bearing is known
    return float(cc - (ac * ac * bb - 2.0 * ac * bc * ab + bc * bc * aa) / determinant)


def _valleys(model: ViewModel) -> FloatArray:
    """Return starts (m, 3 + k) that fit no worse than their neighbours in depth, at most the two best."""
    starts = model.on_ray(_STARTS / model.baseline)
    costs = model.costs_without_pose_errors(starts[:, :3])
    padded = np.concatenate([[np.inf], costs, [np.inf]])
    low = np.flatnonzero(np.isfinite(costs) & (costs <= padded[:-2]) & (costs <= padded[2:]))
    return starts[low[np.argsort(costs[low])][:2]]
