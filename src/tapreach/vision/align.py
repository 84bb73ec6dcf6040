"""Where a patch lies in another picture, to a fraction of a pixel, and how sure that is.

Inverse compositional Gauss-Newton over an affine warp, gain and offset of brightness, with Tukey weights
against occlusion and background, and a prior that keeps the linear part near its start where texture is
weak. Source: Baker and Matthews, "Lucas-Kanade 20 years on", IJCV 2004, parts 1 (section 3.2) and 3.
"""

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import GRADIENT_NOISE, Patch
from tapreach.vision.region import Region, region_around
from tapreach.vision.warp import Warp, chained, inverted, is_seen, patch_grid, scale_of, warp_at

_ITERATIONS = 12
_STANDS_STILL = 0.01
_LINEAR_SIGMA = 0.04
"""Prior of each entry of the linear part against its starting value."""
_LEAST_SEEN = 0.2
"""Share of a patch's weight that must be on the picture."""
_LEAST_NOISE = 2.0
"""Grey levels; a JPEG is never quieter."""
_LEAST_KNOWN = 0.003
"""Information of a direction without texture [1/px²]."""
_NEIGHBOURS = 3.0
"""Residuals of neighbouring pixels are alike: about so many count as one measurement."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """A placed patch.

    covariance: (2, 2) [px²] of the patch's centre in the picture, by noise alone.
    score: weighted correlation with the patch, -1 to 1. support: share of the patch that agrees, 0 to 1.
    agreement: (n²,) of each sample, 0 to 1. slackness: (2, 2) how much less texture holds the patch in each
    direction than in its best one: 1 across the best, large along an edge.
    """

    warp: Warp
    covariance: FloatArray
    score: float
    support: float
    agreement: FloatArray
    slackness: FloatArray


@dataclass(eq=False)
class _Fit:
    """The state of the iteration."""

    warp: Warp
    gain: float
    offset: float
    deviation: FloatArray
    information: FloatArray
    robust: FloatArray
    noise: float = 1.0


def align(
    patch: Patch, picture: Gray, start: Warp, search: int = 0, layer: FloatArray | None = None
) -> Alignment | None:
    """Return where `patch` lies near `start`; None when it runs off or there is nothing to hold on to.

    layer: (n²,) trust in each sample, 0 to 1, all 1 when left out. With `search` all shifts up to that many
    patch pixels are compared first, which widens the basin.
    """
    weights = patch.weights * is_seen(start, patch.half, picture.shape)
    if weights.sum() <= _LEAST_SEEN * (weights.size / 4.0) or weights.sum() < 0.5 * patch.weights.sum():
        return None
    if layer is not None:
        weights = weights * layer
    region = region_around(picture, start, patch.half + search)
    warp = _best_shift(patch, region, start, search) if search else start
    fit = _refine(patch, region, warp, weights)
    if fit is None or not _is_plausible(fit.warp, start, patch.half + search):
        return None
    return _judged(patch, region, fit, weights)


def _best_shift(patch: Patch, region: Region, start: Warp, search: int) -> Warp:
    seen = region.sample(start, patch.half + search)
    scores = cv2.matchTemplate(seen, patch.values, cv2.TM_CCOEFF_NORMED)
    row, column = np.unravel_index(int(np.argmax(scores)), scores.shape)
    return chained(start, warp_at(float(column) - search, float(row) - search))


def _refine(patch: Patch, region: Region, start: Warp, weights: FloatArray) -> _Fit | None:
    template = patch.values.ravel().astype(np.float64)
    seen = region.sample(start, patch.half).ravel().astype(np.float64)
    gain, offset = _brightness(seen, template, weights)
    fit = _Fit(start, gain, offset, np.zeros(8), np.eye(8), weights)
    jacobian = _jacobian(patch, template)
    for _ in range(_ITERATIONS):
        shift = _step(fit, jacobian, seen - fit.gain * template - fit.offset, weights)
        if shift is None:
            return None
        if shift < _STANDS_STILL:
            break
        seen = region.sample(fit.warp, patch.half).ravel().astype(np.float64)
    return fit


def _step(fit: _Fit, jacobian: FloatArray, residual: FloatArray, weights: FloatArray) -> float | None:
    """Make one Gauss-Newton step in place; return its shift [patch px], None when it leads nowhere."""
    noise, fit.robust = _tukey(residual, weights)
    fit.noise = noise
    scaled = jacobian * ([fit.gain] * 6 + [1.0, 1.0])
    weighted = scaled * (fit.robust / noise**2)[:, None]
    fit.information = weighted.T @ scaled + _PRIOR
    step = np.linalg.solve(fit.information, weighted.T @ residual + _PRIOR @ fit.deviation)
    linear = np.array([[1.0 + step[0], step[1], step[4]], [step[2], 1.0 + step[3], step[5]]])
    if abs(float(np.linalg.det(linear[:, :2]))) < 0.1:
        return None
    fit.warp = chained(fit.warp, inverted(linear))
    fit.deviation[:4] -= step[:4]
    fit.gain, fit.offset = fit.gain + float(step[6]), fit.offset + float(step[7])
    return float(np.hypot(step[4], step[5])) if 0.2 < fit.gain < 5.0 else None


# The tiny entries keep a patch of one colour solvable; they change nothing elsewhere.
_PRIOR = np.diag([_LINEAR_SIGMA**-2] * 4 + [1e-6, 1e-6, 1e-6, 1e-6])


def _jacobian(patch: Patch, template: FloatArray) -> FloatArray:
    """Return d value / d (xx, xy, yx, yy, shift x, shift y, gain, offset): (n², 8), for a gain of 1."""
    x, y = patch_grid(patch.half).T
    by_x, by_y = patch.gradients.T
    ones = np.ones_like(template)
    return np.stack([by_x * x, by_x * y, by_y * x, by_y * y, by_x, by_y, template, ones], axis=1)


def _brightness(seen: FloatArray, template: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Return the gain and offset that best take the template to what is seen."""
    total = weights.sum()
    mean_seen, mean_template = weights @ seen / total, weights @ template / total
    spread = weights @ (template - mean_template) ** 2
    together = weights @ ((seen - mean_seen) * (template - mean_template))
    gain = float(np.clip(together / spread, 0.25, 4.0)) if spread > 0.0 else 1.0
    return gain, float(mean_seen - gain * mean_template)


def _tukey(residual: FloatArray, weights: FloatArray) -> tuple[float, FloatArray]:
    """Return the noise [grey levels] by the median deviation, and robust weights (n²,)."""
    counted = np.abs(residual[weights > 0.2])
    noise = max(_LEAST_NOISE, 1.4826 * float(np.median(counted))) if counted.size else _LEAST_NOISE
    outlying = np.minimum(np.abs(residual) / (4.685 * noise), 1.0)
    return noise, weights * (1.0 - outlying**2) ** 2


def _judged(patch: Patch, region: Region, fit: _Fit, weights: FloatArray) -> Alignment:
    template = patch.values.ravel().astype(np.float64)
    seen = region.sample(fit.warp, patch.half).ravel().astype(np.float64)
    in_patch = _covariance_of_shift(fit) * _NEIGHBOURS
    linear = fit.warp[:, :2]
    values, axes = np.linalg.eigh(in_patch)
    turned = linear / scale_of(fit.warp) @ axes
    slackness = turned * (values / values[0]) @ turned.T
    support = float(fit.robust.sum() / patch.weights.sum())
    score = correlation(seen, template, weights)
    agreement = np.where(weights > 0.0, fit.robust / np.maximum(weights, 1e-12), 1.0)
    return Alignment(fit.warp, linear @ in_patch @ linear.T, score, support, agreement, slackness)


def _covariance_of_shift(fit: _Fit) -> FloatArray:
    """Return (2, 2) [patch px²]; what gradients of noise alone would tell is taken off, so that the way
    along an edge is known to be unknown.
    """
    known = np.linalg.inv(np.linalg.inv(fit.information)[4:6, 4:6])
    values, axes = np.linalg.eigh(known)
    by_noise = fit.gain**2 * GRADIENT_NOISE**2 * float(fit.robust.sum()) / fit.noise**2
    kept = np.maximum(values - by_noise, _LEAST_KNOWN)
    return np.asarray((axes / kept) @ axes.T)


def correlation(seen: npt.NDArray[Any], template: npt.NDArray[Any], weights: FloatArray) -> float:
    """Return the weighted correlation of two rows of grey values (n,), -1 to 1; 0 for one colour."""
    total = weights.sum()
    a, b = seen - weights @ seen / total, template - weights @ template / total
    spread = float(np.sqrt((weights @ a**2) * (weights @ b**2)))
    return float(weights @ (a * b)) / spread if spread > 1e-9 else 0.0


def _is_plausible(warp: Warp, start: Warp, reach: int) -> bool:
    """Tell whether the warp stayed near its start and did not fold or shear the patch away."""
    change = scale_of(warp) / scale_of(start)
    moved = float(np.hypot(*(warp[:, 2] - start[:, 2]))) / scale_of(start)
    singular = np.linalg.svd(warp[:, :2], compute_uv=False)
    is_upright = float(np.linalg.det(warp[:, :2])) > 0.0
    return (
        is_upright and 0.6 < change < 1.7 and moved < reach and float(singular[0]) < 3.0 * float(singular[1])
    )
