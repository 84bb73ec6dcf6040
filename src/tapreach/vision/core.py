"""How well a tapped place is held by the texture at the place itself, and not by what is around it.

A patch whose middle is plain is held by its rim: by another surface, or by an outline that wanders over a
round thing as the camera moves. It fits as well as ever and yet leads astray, by as much as the numbers here
say: taken from places followed through rendered pictures against the truth.
"""

import math

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import GRADIENT_NOISE, NOISE, patch_of_half
from tapreach.vision.warp import Warp, scale_of, warp_at

_CORES = ((3, 1.0, 0.5), (5, 0.7, 2.0))
"""Half size of a core [px]; sigma of the place per sigma to which the core can be placed; most sigma [px]."""
_LOOSE_AT_ONCE, _ALL_LOOSE = 0.1, 0.3
"""Share of a place's looseness that counts from the first; log of the change in size at which all does."""


def looseness(picture: Gray, u: float, v: float) -> FloatArray:
    """Return the covariance (2, 2) [px² of this picture] that the place at (u, v) has, seen from elsewhere,
    for want of texture of its own.
    """
    return np.asarray(sum(_of_core(picture, u, v, *core) for core in _CORES))


def seen_from_elsewhere(covariance: FloatArray, warp: Warp, loose: FloatArray) -> float:
    """Return one sigma [px] of a place found at `warp` with `covariance` (2, 2) [px²] whose looseness in the
    tapped picture is `loose` (2, 2) [px²].
    """
    share = min(1.0, _LOOSE_AT_ONCE + abs(math.log(scale_of(warp))) / _ALL_LOOSE)
    linear = share * warp[:, :2]
    return sigma_of(covariance + linear @ loose @ linear.T)


def sigma_of(covariance: FloatArray) -> float:
    """Return the root mean of the variances of the two coordinates [px]."""
    return math.sqrt(float(np.trace(covariance)) / 2.0)


def _of_core(picture: Gray, u: float, v: float, half: int, factor: float, most: float) -> FloatArray:
    patch = patch_of_half(picture, warp_at(u, v), half)
    values, axes = np.linalg.eigh(patch.structure)
    known = np.maximum(values - GRADIENT_NOISE**2 * float(patch.weights.sum()), 0.0)
    sigmas = [min(factor * NOISE / math.sqrt(k), most) if k > 0.0 else most for k in known]
    return np.asarray((axes * np.square(sigmas)) @ axes.T)
