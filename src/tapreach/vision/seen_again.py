"""Finds a thing again, by how it looked in an earlier picture, in the region where it may be by now.

It may have been pushed, and be seen from nearer or farther. Compared are the place itself and the whole thing
around it; what is known of it beforehand decides among what looks alike.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.look import fit_look, tapped_look
from tapreach.vision.patch import cut_patch
from tapreach.vision.region import Values, region_around
from tapreach.vision.warp import scale_of, warp_at

_WITHIN = 3.0
"""Sigmas around the expected place in which it is sought."""
_MOST_REACH = 160
"""So far around the expected place it is sought at most [px]."""
_LEAST_HALF, _MOST_HALF = 8, 64
"""Half sizes of what is compared [px]."""
_THING = 2.0
"""The thing is taken to be at least so many times as large as the patch that can be followed."""
_LEAST_LIKENESS, _CLEARLY = 0.6, 0.04
"""Mean correlation of place and thing, and by how much more than anywhere else."""
_PER_SIGMA = 0.01
"""What a squared sigma off the expected place takes from the correlation."""


@dataclass(frozen=True, eq=False)
class Expected:
    """Where a thing should be in a picture: pixel (2,), covariance (2, 2) [px²], and how many times as large
    as in the earlier picture it may be seen.
    """

    pixel: FloatArray
    covariance: FloatArray
    scales: tuple[float, ...] = (1.0,)


@dataclass(frozen=True, eq=False)
class SeenAgain:
    """Where it is: pixel (2,), how many times as large as before, and its mean correlation, -1 to 1."""

    pixel: FloatArray
    scale: float
    likeness: float


def seen_again(
    earlier: Gray, pixel: tuple[float, float], half_size: float, picture: Gray, there: Expected
) -> SeenAgain | None:
    """Return where what was at `pixel` of the `earlier` picture is in this one; None where nothing within the
    expected region looks like it, or two places do.

    half_size: how far the thing reaches around the pixel in the earlier picture, about [px].
    """
    patch = cut_patch(earlier, *pixel)
    own = patch.half * patch.step
    halves = own, max(half_size, _THING * own)
    maps = {scale: _likeness(earlier, pixel, halves, picture, there, scale) for scale in there.scales}
    scale = max(maps, key=lambda each: float(maps[each].max()))
    likeness = maps[scale]
    row, column = np.unravel_index(int(np.argmax(likeness)), likeness.shape)
    best = float(likeness[row, column])
    beside = round(max(own * scale, _LEAST_HALF))
    likeness[max(0, row - beside) : row + beside + 1, max(0, column - beside) : column + beside + 1] = -1.0
    if best < _LEAST_LIKENESS or best - float(likeness.max()) < _CLEARLY:
        return None
    reach = likeness.shape[0] // 2
    found = np.round(there.pixel) + np.array([float(column) - reach, float(row) - reach])
    return _refined(earlier, pixel, picture, SeenAgain(found, scale, best))


def _likeness(
    earlier: Gray,
    pixel: tuple[float, float],
    halves: tuple[float, float],
    picture: Gray,
    there: Expected,
    scale: float,
) -> Values:
    """Return how like each pixel of the region around the expected one looks (2·reach + 1)², with what is
    known beforehand; -1 beyond the region.
    """
    sigma = float(np.sqrt(np.linalg.eigvalsh(there.covariance)[-1]))
    reach = min(max(round(_WITHIN * sigma), _LEAST_HALF), _MOST_REACH)
    shown = warp_at(*(float(each) for each in np.round(there.pixel)))
    total = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
    for size in halves:
        half = round(min(max(size * scale, _LEAST_HALF), _MOST_HALF))
        as_before = warp_at(*pixel, 1.0 / scale)
        template = region_around(earlier, as_before, half).sample(as_before, half)
        seen = region_around(picture, shown, half + reach).sample(shown, half + reach)
        total += cv2.matchTemplate(seen, template, cv2.TM_CCOEFF_NORMED) / len(halves)
    off = _off(reach, there)
    return np.where(off > _WITHIN**2, np.float32(-1.0), total - _PER_SIGMA * off).astype(np.float32)


def _off(reach: int, there: Expected) -> FloatArray:
    """Return the squared distance from the expected place in sigmas, for each pixel of the region."""
    down, right = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    away = np.stack([right, down], axis=-1) - (there.pixel - np.round(there.pixel))
    return np.asarray(np.einsum("...i,ij,...j->...", away, np.linalg.inv(there.covariance), away))


def _refined(earlier: Gray, pixel: tuple[float, float], picture: Gray, found: SeenAgain) -> SeenAgain:
    """Return the place to a fraction of a pixel, where the patch settles near it."""
    look = tapped_look(cut_patch(earlier, *pixel), earlier)
    u, v = map(float, found.pixel)
    fit = fit_look(look, picture, warp_at(u, v, found.scale))
    near = 0.5 * look.patch.half * look.patch.step * found.scale
    if fit is None or float(np.hypot(*(fit.warp[:, 2] - found.pixel))) > near:
        return found
    return SeenAgain(fit.warp[:, 2].copy(), scale_of(fit.warp), found.likeness)
