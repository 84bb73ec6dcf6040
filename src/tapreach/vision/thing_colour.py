"""Which colours are the thing's: histograms inside and around a first outline."""

import cv2
import numpy as np
from scipy.ndimage import gaussian_filter

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Color
from tapreach.vision.thing_parallax import Cells, Mask

_BINS, _SHIFT = 16, 4
_SMOOTHED = 0.7
"""Colors this near count as alike [bins]."""
_RARE = 1e-3
"""Share of a colour that was not met."""
_STRONGEST = 2.0
_LEAST_CELLS = 20


def colour_evidence(picture: Color, inside: Mask, around: Mask) -> Cells:
    """Return log odds, -2 to 2, that cells have the colour of what is `inside`, not of what is `around`;
    zeros where either has fewer than 20 cells.
    """
    if min(int(inside.sum()), int(around.sum())) < _LEAST_CELLS:
        return np.zeros(picture.shape[:2], np.float32)
    bins = (picture >> _SHIFT).astype(np.intp)
    index = (bins[..., 0] * _BINS + bins[..., 1]) * _BINS + bins[..., 2]
    odds = np.log((_shares(index[inside]) + _RARE) / (_shares(index[around]) + _RARE)).astype(np.float32)
    return np.clip(np.asarray(cv2.blur(odds[index], (3, 3)), np.float32), -_STRONGEST, _STRONGEST)


def _shares(index: np.ndarray) -> FloatArray:
    counts = np.bincount(index, minlength=_BINS**3).astype(np.float64).reshape(_BINS, _BINS, _BINS)
    return np.asarray(gaussian_filter(counts, _SMOOTHED, mode="nearest").ravel() / len(index))
