"""The colours right around what was tapped, and how much of them another picture shows in some place.

What was tapped from far may be hardly more than the spot itself, beside other things or behind them. Whatever
was followed, found again or measured since: the thing has the colours of that spot.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.image_io import Color
from tapreach.vision.own_colours import colour_bins, counts_of, cut_to, shares_of

_LEAST_HALF = 2.0
"""[px]"""
_ALIKE = 2.0, 1.0, 1.0
"""As in own_colours, wider: a few pixels tell it, in other light."""
_INSIDE = 0.8


@dataclass(frozen=True, eq=False)
class TappedSpot:
    """colours (bins,): around what was tapped, from a distance [m]."""

    colours: FloatArray
    distance: float


def colours_around(picture: Color, spot: Pixel, half: float) -> FloatArray:
    """Return the shares (bins,) of the colours so far around a pixel [px], about 1 in all."""
    half = max(half, _LEAST_HALF)
    around = PixelBox(spot.u - half, spot.v - half, spot.u + half, spot.v + half)
    return shares_of(counts_of(cut_to(colour_bins(picture), around)), _ALIKE)


def common_with(picture: Color, box: PixelBox, scale: float, colours: FloatArray) -> float:
    """Return how much what fills `box` has in common with `colours`, 0 to 1 (Bhattacharyya's coefficient),
    when it is seen as small as from where those were taken: `scale` times as large, 1 at most.
    """
    inside = box.inner(_INSIDE)
    seen = cut_to(picture, inside)
    size = (max(1, round(scale * seen.shape[1])), max(1, round(scale * seen.shape[0])))
    small = cv2.resize(seen, size, interpolation=cv2.INTER_AREA).astype(np.uint8) if scale < 1.0 else seen
    shares = shares_of(counts_of(colour_bins(small)), _ALIKE)
    return float(np.sqrt(colours * shares).sum())
