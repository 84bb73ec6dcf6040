"""The look of a tapped place: a small square of grey values with its gradients and its texture."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.region import Values, region_around
from tapreach.vision.warp import Warp, is_seen, patch_grid, warp_at

HALF_SIZES = (11, 15, 20)
NOISE = 3.0
"""Grey levels of camera noise assumed before any is measured."""
GOOD_SIGMA = 0.12
"""A patch that can be placed this well [px] is large enough: a larger one only sees more background."""
POOR_SIGMA = 0.35
POOR_CONTRAST = 4.0


@dataclass(frozen=True, eq=False)
class Patch:
    """Grey values (n, n) around a tapped pixel, as seen in the frame that was tapped.

    `weights` (n²,) fall off from the centre, so that the tapped surface counts more than what lies behind
    it, and are 0 where the picture ended. `picture_from_patch` is the warp it was cut out with.
    """

    half: int
    values: Values
    weights: FloatArray
    picture_from_patch: Warp

    @cached_property
    def gradients(self) -> FloatArray:
        """Derivatives of the values by x and y, (n², 2) [grey levels per px]."""
        by_y, by_x = np.gradient(self.values.astype(np.float64))
        return np.stack([by_x.ravel(), by_y.ravel()], axis=1)

    @cached_property
    def structure(self) -> FloatArray:
        """Structure tensor (2, 2): weighted sum of the gradients' outer products [grey levels² per px²]."""
        return np.asarray((self.gradients * self.weights[:, None]).T @ self.gradients)

    @property
    def contrast(self) -> float:
        """Weighted standard deviation of the values [grey levels]."""
        flat, total = self.values.ravel().astype(np.float64), float(self.weights.sum())
        mean = float(self.weights @ flat) / total
        return math.sqrt(float(self.weights @ (flat - mean) ** 2) / total)

    @property
    def expected_sigma(self) -> float:
        """How well it can be placed in its worse direction under NOISE [px]; may be infinite."""
        least = float(np.linalg.eigvalsh(self.structure)[0])
        return NOISE / math.sqrt(least) if least > 0.0 else math.inf

    @property
    def weakness(self) -> str:
        """Why it will be hard to follow; '' when it is not."""
        if self.contrast < POOR_CONTRAST:
            return "the place is almost of one colour"
        if self.expected_sigma > POOR_SIGMA:
            return "the place has texture in one direction only, like an edge or a stripe"
        return ""


def cut_patch(picture: Gray, u: float, v: float) -> Patch:
    """Return the smallest patch around (u, v) that has texture enough, or the largest there is."""
    patch = patch_of_half(picture, warp_at(u, v), HALF_SIZES[0])
    for half in HALF_SIZES[1:]:
        if patch.expected_sigma <= GOOD_SIGMA:
            break
        patch = patch_of_half(picture, warp_at(u, v), half)
    return patch


def patch_of_half(picture: Gray, picture_from_patch: Warp, half: int) -> Patch:
    """Return the patch of (2·half + 1)² samples seen through a warp."""
    values = region_around(picture, picture_from_patch, half).sample(picture_from_patch, half)
    squared = (patch_grid(half) ** 2).sum(axis=1)
    weights = np.exp(-squared / (2.0 * (0.6 * half) ** 2))
    weights[~is_seen(picture_from_patch, half, picture.shape)] = 0.0
    return Patch(half, values, weights, picture_from_patch)
