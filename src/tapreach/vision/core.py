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
from tapreach.vision.warp import warp_at

_CORES = ((3, 1.0, 0.5), (5, 0.7, 2.0))
"""Half size of a core [px]; sigma of the place per sigma to which the core can be placed; most sigma [px]."""


def looseness(picture: Gray, u: float, v: float) -> FloatArray:
    """Return the covariance (2, 2) [px² of this picture] that the place at (u, v) has, seen from elsewhere,
    for want of texture of its own.
    """
    return np.asarray(sum(_of_core(picture, u, v, *core) for core in _CORES))


def _of_core(picture: Gray, u: float, v: float, half: int, factor: float, most: float) -> FloatArray:
    patch = patch_of_half(picture, warp_at(u, v), half)
    values, axes = np.linalg.eigh(patch.structure)
    known = np.maximum(values - GRADIENT_NOISE**2 * float(patch.weights.sum()), 0.0)
    sigmas = [min(factor * NOISE / math.sqrt(k), most) if k > 0.0 else most for k in known]
    return np.asarray((axes * np.square(sigmas)) @ axes.T)
