"""The most probable target and pose errors: damped Gauss-Newton, and the information it leaves (5 to 7)."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

# Inverse depths to start from, in units of 1 over the baseline.
_STARTS = np.array([0.0, 0.01, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6, 1.0, 2.0, 4.0])
_ITERATIONS = 60


@dataclass(frozen=True)
class Solution:
    """x at the minimum, cost = squared residuals over sigma plus |z|², whitened residuals, information."""

    x: FloatArray
    cost: float
    residuals: FloatArray
    information: FloatArray
    jacobian: FloatArray

    @property
    def inverse_depth(self) -> float:
        """rho = 1/Z in the first camera [1/m]; below zero when the rays diverge."""
        return float(self.x[2])


@dataclass(frozen=True)
class _Linearised:
    cost: float
    gradient: FloatArray
    information: FloatArray
    residuals: FloatArray
    jacobian: FloatArray


def solve(model: ViewModel) -> Solution | None:
    """Return the best minimum over several starts in depth; None where no depth has it before all cameras."""
    best: Solution | None = None
    for start in _valleys(model):
        found = descend(model, start, np.ones(model.unknowns, dtype=bool))
        if found is not None and (best is None or found.cost < best.cost):
            best = found
    return best


def descend(
    model: ViewModel, start: FloatArray, free: npt.NDArray[np.bool_], tolerance: float = 1e-13
) -> Solution | None:
    """Return the minimum reached from `start` over the unknowns that are `free`; None if start is infeasible.

    It ends after a step that promised to lower the cost by less than `tolerance`. Levenberg's damping is
    scaled by the information's own diagonal; steps that put the target behind a camera are refused like steps
    that raise the cost.
    """
    x, damping = start.copy(), 1e-9
    now = _linearise(model, x)
    if now is None:
        return None
    for _ in range(_ITERATIONS):
        step = _damped_step(now, free, damping)
        promised = float(-now.gradient @ step)
        after = _linearise(model, x + step)
        if after is not None and after.cost <= now.cost * (1.0 + 1e-14):
            x, now, damping = x + step, after, max(damping * 0.1, 1e-12)
        else:
            damping = max(damping * 10.0, 1e-6)
        if promised < tolerance * max(1.0, now.cost):
            break
    return Solution(x, now.cost, now.residuals, now.information, now.jacobian)


def information_at(model: ViewModel, x: FloatArray) -> FloatArray | None:
    """Return the information (3 + k, 3 + k) at x, equation (7); None where x lies behind a camera."""
    linearised = _linearise(model, x)
    return None if linearised is None else linearised.information


def target_information(information: FloatArray) -> FloatArray:
    """Return the information (3, 3) on (a, b, rho), the pose errors marginalised (Schur complement)."""
    target, mixed, errors = information[:3, :3], information[:3, 3:], information[3:, 3:]
    if errors.size == 0:
        return target
    return np.asarray(target - mixed @ np.linalg.solve(errors, mixed.T))


def covariance_of(information: FloatArray) -> FloatArray:
    """Return the inverse; scaled first, as the unknowns of a near target differ by many powers of ten."""
    scale = 1.0 / np.sqrt(np.diag(information))
    scaling = np.outer(scale, scale)
    return np.asarray(np.linalg.inv(information * scaling) * scaling, dtype=np.float64)


def inverse_depth_information(on_target: FloatArray) -> float:
    """Return the information [m²] on rho alone, bearing marginalised; 0 or a rounding error when singular."""
    (aa, ab, ac), (_, bb, bc), (_, _, cc) = on_target.tolist()
    determinant = aa * bb - ab * ab
    if not determinant > 1e-14 * aa * bb:
        return 0.0  # not even the bearing is known
    return float(cc - (ac * ac * bb - 2.0 * ac * bc * ab + bc * bc * aa) / determinant)


def _linearise(model: ViewModel, x: FloatArray) -> _Linearised | None:
    prediction = model.predict(x)
    if not model.is_in_front(prediction):
        return None
    residuals, jacobian = model.whitened(prediction)
    flat, normals = jacobian.reshape(-1, model.unknowns), x[3:]
    information, gradient = flat.T @ flat, flat.T @ residuals.ravel()
    errors = np.arange(3, model.unknowns)
    information[errors, errors] += 1.0
    gradient[3:] += normals
    cost = float(np.sum(residuals * residuals) + normals @ normals)
    return _Linearised(cost, gradient, information, residuals, flat)


def _damped_step(now: _Linearised, free: npt.NDArray[np.bool_], damping: float) -> FloatArray:
    information, gradient = now.information[np.ix_(free, free)], now.gradient[free]
    diagonal = np.diag(information)
    # The floor keeps an unknown about which nothing is known where it is.
    floor = np.where(diagonal > 0.0, damping * diagonal, 1.0)
    step = np.zeros(len(free))
    step[free] = -np.linalg.solve(information + np.diag(floor), gradient)
    return step


def _valleys(model: ViewModel) -> list[FloatArray]:
    """Return starts that fit no worse than their neighbours in depth, at most the two best."""
    starts = np.stack([model.at(float(rho)) for rho in _STARTS / model.baseline])
    costs = model.costs_without_pose_errors(starts[:, :3])
    padded = np.concatenate([[np.inf], costs, [np.inf]])
    low = np.flatnonzero(np.isfinite(costs) & (costs <= padded[:-2]) & (costs <= padded[2:]))
    return [starts[i] for i in low[np.argsort(costs[low])][:2]]
