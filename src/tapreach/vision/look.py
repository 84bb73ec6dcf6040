"""What a followed place looks like: as it was tapped, and as it was seen later from nearer or farther."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.align import Alignment, align, correlation
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import Patch, cut_patch, patch_of_half
from tapreach.vision.region import region_around
from tapreach.vision.warp import Warp, chained, inverted, is_seen, scale_of, warp_at

_SEARCH = 4
_LEAST_SIGMA = 0.12
"""What a place that is round or turns away looks different by, across its best texture [samples]."""
_SIGMA_PER_LOG_SCALE = 0.8
"""A place seen from nearer or farther looks different: so much is added per factor e [px of the tapped
frame].
"""
_LEARNING = 0.15
"""Share by which one picture changes what is held to be the place's own layer."""
_LEAST_LAYER = 0.05
_CONTEXT_SCALE, _CONTEXT_HALF = 3.0, 12


@dataclass(frozen=True, eq=False)
class Look:
    """A patch to compare with: the tapped one, or one taken later.

    context: the same place with its wider surroundings. scale: how much larger than in the tapped frame the
    place was seen when this look was taken. tapped_from_patch: its warp against the tapped patch.
    covariance: (2, 2) of its centre against the tapped one [px² of the tapped frame]. layer: (n²,) how
    surely each sample moves with the place, 0 to 1: a patch at an object's outline shows what lies behind it
    as well, and that moves otherwise.
    """

    patch: Patch
    context: Patch
    scale: float
    tapped_from_patch: Warp
    covariance: FloatArray
    layer: FloatArray

    def learned(self, agreement: FloatArray) -> "Look":
        """Return the look after a picture in which the samples agreed by (n²,), 0 to 1."""
        return self.with_layer((1.0 - _LEARNING) * self.layer + _LEARNING * agreement)

    def with_layer(self, layer: FloatArray) -> "Look":
        """Return the look with another layer (n²,)."""
        return replace(self, layer=np.maximum(layer, _LEAST_LAYER))


@dataclass(frozen=True, eq=False)
class Fit:
    """The place in a picture: warp from the tapped patch, score, support, which look it was found by, and how
    far its samples agreed (n²,).

    own, inherited: covariances (2, 2) of its centre [px²], of this fit and of the look, which stays the same
    from picture to picture.
    """

    warp: Warp
    own: FloatArray
    inherited: FloatArray
    score: float
    support: float
    look: Look
    agreement: FloatArray

    @property
    def covariance(self) -> FloatArray:
        """Of the place's centre against the tapped place, (2, 2) [px²]."""
        return self.own + self.inherited

    @property
    def sigma(self) -> float:
        """Root mean of the variances of the two coordinates [px]."""
        return math.sqrt(float(np.trace(self.covariance)) / 2.0)

    def fused_with(self, place: FloatArray, covariance: FloatArray) -> "Fit":
        """Return the fit moved by what is known beforehand: place (2,) [px] with its covariance (2, 2).

        It matters where the patch says little itself: along an edge.
        """
        share = np.linalg.solve(self.own + covariance, covariance).T
        centre = place + share @ (self.warp[:, 2] - place)
        left = (np.eye(2) - share) @ covariance
        warp = np.column_stack([self.warp[:, :2], centre])
        return replace(self, warp=warp, own=(left + left.T) / 2.0)


def tapped_look(patch: Patch, picture: Gray) -> Look:
    """Return the look of the tapped patch itself."""
    where = patch.picture_from_patch
    tapped_from_patch = np.column_stack([where[:, :2], np.zeros(2)])
    context = _context_of(picture, warp_at(float(where[0, 2]), float(where[1, 2])))
    return Look(patch, context, 1.0, tapped_from_patch, np.zeros((2, 2)), np.ones(patch.weights.size))


def later_look(picture: Gray, fit: Fit) -> Look:
    """Return a new look taken where `fit` found the place."""
    u, v = map(float, fit.warp[:, 2])
    patch, scale = cut_patch(picture, u, v), scale_of(fit.warp)
    tapped_from_picture = inverted(fit.warp)
    tapped_from_patch = chained(tapped_from_picture, patch.picture_from_patch)
    linear = tapped_from_picture[:, :2]
    covariance = linear @ fit.covariance @ linear.T
    context = _context_of(picture, warp_at(u, v))
    return Look(patch, context, scale, tapped_from_patch, covariance, np.ones(patch.weights.size))


def context_score(look: Look, picture: Gray, warp: Warp) -> float:
    """Return how far the wider surroundings agree when the tapped patch is seen through `warp`, -1 to 1."""
    wide = chained(warp, warp_at(0.0, 0.0, _CONTEXT_SCALE / look.scale))
    weights = look.context.weights * is_seen(wide, _CONTEXT_HALF, picture.shape)
    if weights.sum() < 0.4 * look.context.weights.sum():
        return -1.0
    seen = region_around(picture, wide, _CONTEXT_HALF).sample(wide, _CONTEXT_HALF)
    return correlation(seen.ravel(), look.context.values.ravel(), weights)


def _context_of(picture: Gray, warp: Warp) -> Patch:
    wide = chained(warp, warp_at(0.0, 0.0, _CONTEXT_SCALE))
    return patch_of_half(picture, wide, _CONTEXT_HALF)


def fit_look(look: Look, picture: Gray, start: Warp) -> Fit | None:
    """Return where the look is found near `start`, a warp from the tapped patch."""
    begin = chained(start, look.tapped_from_patch)
    found: Alignment | None = align(look.patch, picture, begin, _SEARCH, look.layer)
    if found is None:
        return None
    warp = chained(found.warp, inverted(look.tapped_from_patch))
    change = _SIGMA_PER_LOG_SCALE * math.log(scale_of(found.warp))
    size = scale_of(warp)
    shape = (_LEAST_SIGMA * look.patch.step) ** 2 * found.slackness
    own = found.covariance + shape + (size * change / look.scale) ** 2 * np.eye(2)
    return Fit(warp, own, size**2 * look.covariance, found.score, found.support, look, found.agreement)
