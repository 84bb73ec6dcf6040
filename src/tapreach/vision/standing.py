"""Which pixels surely do not show the floor, and how far away what they show is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.vision.plane_sweep import Costs, Evened

_AGREES, _DIFFERS = 0.3, 0.35
"""Costs below and above which pictures are taken to show the same, and something else."""
_PARTLY_UNSEEN = 2.5
"""Costs above have windows in them that other pictures do not show."""
_AS_GOOD = 0.1
"""Depths whose cost is this near to the best may be the right one too."""


@dataclass(frozen=True, eq=False)
class StandingPixels:
    """n pixels of a picture (row, column) that show no floor: the inverse depths [1/m] between which what
    they show must lie, (n,) each, and the best of them.
    """

    rows: NDArray[np.int_]
    columns: NDArray[np.int_]
    best: FloatArray
    nearest: FloatArray
    farthest: FloatArray


def standing_pixels(by_depth: Costs, inverse_depths: FloatArray, by_floor: Evened) -> StandingPixels:
    """Return the pixels at which some depth agrees and the floor does not.

    by_depth (planes, rows, columns): costs at inverse_depths (planes,) [1/m], rising. by_floor (rows,
    columns): the cost if the floor were seen.
    """
    planes = np.argmin(by_depth, axis=0)
    best = np.take_along_axis(by_depth, planes[None], axis=0)[0]
    is_other = (by_floor > np.maximum(_DIFFERS, 2.0 * best + _AS_GOOD)) & (by_floor < _PARTLY_UNSEEN)
    rows, columns = np.nonzero((best < _AGREES) & is_other)
    costs = by_depth[:, rows, columns]
    is_as_good = costs <= best[rows, columns] + _AS_GOOD
    last = len(inverse_depths) - 1
    low = np.maximum(np.argmax(is_as_good, axis=0) - 1, 0)
    high = np.minimum(last - np.argmax(is_as_good[::-1], axis=0) + 1, last)
    found = inverse_depths[planes[rows, columns]]
    return StandingPixels(rows, columns, found, inverse_depths[high], inverse_depths[low])
