"""The most probable errors of a camera's step, given pairs of pixels: reweighted Gauss-Newton."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tapreach.estimation.camera_step import CameraStep
from tapreach.estimation.epipolar import PointPairs, sampson, sampson_distances, turn_alone
from tapreach.estimation.small_rotations import backward_rotations
from tapreach.geometry.finite import FloatArray

_LEAST_NOISE = 0.05
"""No tracker is better than so many pixels."""
_LEAST_WAY = 0.0005
"""A camera that moved less than this [m] has only turned; its parallax is lost in the noise."""
_ROBUST_STEPS, _FINAL_STEPS, _ROUNDS = 8, 1, 3
_SIGMAS_ASIDE = np.linspace(-10.0, 10.0, 31)
_GATE = 3.0
_HIDDEN_OUTLIERS = 20.0
"""Among many that do not fit some seem to: the variance grows by so much times their share. Measured with
30 % of scattered pairs.
"""
_CAUGHT = 0.986
"""Standard deviation of a normal distribution cut off at 3 sigma."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Unit normals of the step's errors (k,), their covariance (k, k), pairs that agree (n,), noise [px]."""

    normals: FloatArray
    covariance: FloatArray
    is_used: npt.NDArray[np.bool_]
    noise_px: float


def fit_step(pairs: PointPairs, step: CameraStep) -> Fit:
    """Return the most probable errors of `step`; pairs that do not fit are left out.

    The turn is least certain along a valley where the direction of travel gives way to it; a wall driven at,
    and things that move, make it flat there. So its spread is taken from the cost along the valley.
    """
    normals, noise = _robust(pairs, step)
    fit = _weighed(_refined(pairs, step, normals, noise), pairs, step)
    return _spread_along_valley(fit, pairs, step)


def _weighed(fit: Fit, pairs: PointPairs, step: CameraStep) -> Fit:
    """Return the fit with pairs that count for what they are worth beside the prior."""
    weights = fit.is_used / (fit.noise_px**2 * _dependence(fit))
    normals = fit.normals
    for _ in range(_FINAL_STEPS):
        residuals, jacobian = residuals_at(pairs, step, normals)
        normals = _improved(residuals, jacobian, weights, normals)
    _, jacobian = residuals_at(pairs, step, normals)
    return replace(fit, normals=normals, covariance=_inverse(_information(jacobian, weights)))


def _dependence(fit: Fit) -> float:
    """Return by how much the variance of what the pairs say together exceeds that of independent ones."""
    return 1.0 + _HIDDEN_OUTLIERS * float(1.0 - fit.is_used.mean())


def _robust(pairs: PointPairs, step: CameraStep) -> tuple[FloatArray, float]:
    """Return normals and noise [px] by Cauchy's loss."""
    normals = np.zeros(step.by_normal.shape[1])
    residuals, jacobian = residuals_at(pairs, step, normals)
    for _ in range(_ROBUST_STEPS):
        weights = _cauchy_weights(residuals)
        moved = _improved(residuals, jacobian, weights, normals)
        is_still = bool(np.linalg.norm(moved - normals) < 0.03)
        normals = moved
        residuals, jacobian = residuals_at(pairs, step, normals)
        if is_still:
            break
    return normals, _spread(residuals)


def _cauchy_weights(residuals: FloatArray) -> FloatArray:
    noise = _spread(residuals)
    scaled = np.max(np.abs(residuals), axis=1) / (2.0 * noise)
    return np.asarray(1.0 / (1.0 + scaled**2) / noise**2)


def _spread_along_valley(fit: Fit, pairs: PointPairs, step: CameraStep) -> Fit:
    """Return the fit with mean and variance along the valley by the truncated cost instead of by the
    linearised one.
    """
    by_turn = step.turn_axis @ step.by_normal[3:]
    along = fit.covariance @ by_turn / max(float(np.sqrt(by_turn @ fit.covariance @ by_turn)), 1e-12)
    places = fit.normals + np.outer(_SIGMAS_ASIDE, along)
    costs = _truncated_costs(pairs, step, places, fit)
    weights = np.exp(-0.5 * (costs - costs.min()))
    weights /= weights.sum()
    mean = float(weights @ _SIGMAS_ASIDE)
    excess = max(0.0, float(weights @ (_SIGMAS_ASIDE - mean) ** 2) - 1.0)
    return replace(
        fit,
        normals=fit.normals + mean * along,
        covariance=fit.covariance + excess * np.outer(along, along),
    )


def _truncated_costs(pairs: PointPairs, step: CameraStep, places: FloatArray, fit: Fit) -> FloatArray:
    """Return the cost (m,) of normals (m, k), no pair counting for more than the gate."""
    rotations, translations = step.moved(places)
    if _has_parallax(step):
        squared = sampson_distances(pairs, rotations, translations) ** 2
    else:
        apart = [turn_alone(pairs, rotation)[0] for rotation in rotations]
        squared = np.max(np.square(apart), axis=2).T
    misfit = np.sum(np.minimum(squared / fit.noise_px**2, _GATE**2), axis=0)
    return np.asarray(misfit / _dependence(fit) + np.sum(places**2, axis=1))


def residuals_at(pairs: PointPairs, step: CameraStep, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return residuals (n, d) [px] and their derivative by the unit normals (n, d, k).

    d is 1, across the epipolar line; for a step without parallax d is 2.
    """
    rotation, translation = step.moved(normals)
    if _has_parallax(step):
        residuals, by_pose = sampson(pairs, rotation, translation)
    else:
        residuals, by_pose = turn_alone(pairs, rotation)
    error = step.by_normal @ normals
    by_error = np.zeros((6, 6))
    by_error[:3, :3], by_error[3:, 3:] = backward_rotations(error[3:])
    return residuals, by_pose @ (by_error @ step.by_normal)


def _has_parallax(step: CameraStep) -> bool:
    return float(np.linalg.norm(step.translation)) > _LEAST_WAY


def _refined(pairs: PointPairs, step: CameraStep, normals: FloatArray, noise: float) -> Fit:
    residuals, jacobian = residuals_at(pairs, step, normals)
    covariance: FloatArray = np.eye(len(normals))
    is_used = np.ones(len(pairs), dtype=np.bool_)
    for _ in range(_ROUNDS):
        is_used = np.max(np.abs(residuals), axis=1) < _GATE * noise
        for _ in range(_FINAL_STEPS):
            normals = _improved(residuals, jacobian, is_used / noise**2, normals)
            residuals, jacobian = residuals_at(pairs, step, normals)
        covariance = _inverse(_information(jacobian, is_used / noise**2))
        fitted = len(normals) - float(np.trace(covariance))
        noise = _noise_of(residuals[is_used], fitted)
    return Fit(normals, covariance, is_used, noise)


def _noise_of(residuals: FloatArray, fitted: float) -> float:
    """Return the noise [px] of what is left after `fitted` unknowns were found from it."""
    freedom = max(1.0, residuals.size - fitted)
    return max(_LEAST_NOISE, float(np.sqrt(np.sum(residuals**2) / freedom)) / _CAUGHT)


def _improved(
    residuals: FloatArray, jacobian: FloatArray, weights: FloatArray, normals: FloatArray
) -> FloatArray:
    gradient = np.tensordot(weights[:, None] * residuals, jacobian, 2) + normals
    return np.asarray(normals - np.linalg.solve(_information(jacobian, weights), gradient))


def _information(jacobian: FloatArray, weights: FloatArray) -> FloatArray:
    size = jacobian.shape[2]
    flat = jacobian.reshape(-1, size)
    weighted = (jacobian * weights[:, None, None]).reshape(-1, size)
    return np.asarray(flat.T @ weighted + np.eye(size))


def _spread(residuals: FloatArray) -> float:
    """Return the standard deviation [px] by the median, which a third of outliers hardly moves."""
    return max(_LEAST_NOISE, 1.4826 * float(np.median(np.abs(residuals))))


def _inverse(information: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.inv(information), dtype=np.float64)
