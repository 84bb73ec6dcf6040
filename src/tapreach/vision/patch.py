"""The look of a tapped place: a small square of grey values with its gradients and its texture."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.region import Values, region_around
from tapreach.vision.warp import Warp, is_seen, patch_grid, scale_of, warp_at

SIZES = ((8, 1.0), (11, 1.0), (15, 1.0), (20, 1.0), (16, 2.0), (20, 2.0))
"""Half sizes in samples, and picture pixels from sample to sample: what has little texture itself is known by
what is around it.
"""
GRADIENT_NOISE = 1.0
"""Grey levels per sample: slopes that JPEG and grain put where there are none."""
NOISE = 3.0
"""Grey levels of camera noise assumed before any is measured."""
SHAPE = 0.1
"""Samples by which edges move when a thing turns: along an edge that is multiplied."""
GOOD_SIGMA = 0.35
"""A patch that can be placed this well [px] is large enough: a larger one only sees more background."""
POOR_SIGMA = 1.2
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
        """How well it can be placed in its worse direction [picture px]; may be infinite."""
        by_noise = GRADIENT_NOISE**2 * float(self.weights.sum())
        least, most = np.linalg.eigvalsh(self.structure) - by_noise
        if least <= 0.0:
            return math.inf
        return self.step * math.sqrt(NOISE**2 / least + SHAPE**2 * most / least)

    @property
    def step(self) -> float:
        """Picture pixels from sample to sample."""
        return scale_of(self.picture_from_patch)

    @property
    def weakness(self) -> str:
        """Why it will be hard to follow; '' when it is not."""
        if self.contrast < POOR_CONTRAST:
            return "the place is almost of one colour"
        if self.expected_sigma > POOR_SIGMA:
            return "the place has texture in one direction only, like an edge or a stripe"
        return ""


def cut_patch(picture: Gray, u: float, v: float) -> Patch:
    """Return the smallest patch around (u, v) that has texture enough, or the one with most."""
    patches = (patch_of_half(picture, warp_at(u, v, step), half) for half, step in SIZES)
    best = next(patches)
    for patch in patches:
        if best.expected_sigma <= GOOD_SIGMA:
            break
        if patch.expected_sigma < best.expected_sigma or math.isinf(best.expected_sigma):
            best = patch
    return best


def patch_of_half(picture: Gray, picture_from_patch: Warp, half: int) -> Patch:
    """Return the patch of (2·half + 1)² samples seen through a warp."""
    values = region_around(picture, picture_from_patch, half).sample(picture_from_patch, half)
    squared = (patch_grid(half) ** 2).sum(axis=1)
    weights = np.exp(-squared / (2.0 * (0.6 * half) ** 2))
    weights[~is_seen(picture_from_patch, half, picture.shape)] = 0.0
    return Patch(half, values, weights, picture_from_patch)
