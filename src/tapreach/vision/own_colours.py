"""Which colours a thing has of its own, and which pixels of another picture speak for them.

From another side a thing looks otherwise, but few change their colours.
"""

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.image_io import Color
from tapreach.vision.region import Values

_SHADES, _HUES = 8, 32
"""Bins of the lightness, and of each of the two colour axes, of CIELAB: the light falls otherwise there."""
_ALIKE = 1.0, 0.7, 0.7
"""Colours this near count as alike, one sigma [bins]."""
_RARE = 1e-3
"""Share of a colour that was not met."""
_STRONGEST = 2.0
_INSIDE, _BESIDE, _AROUND = 0.8, 1.2, 2.0
"""In this share of its box a thing fills most; what lies between these shares is its surroundings."""
_LEAST_OWN = 0.3
"""A thing of whose pixels fewer have a colour of its own is not told by colours."""

Bins = NDArray[np.intp]
T = TypeVar("T", Values, Bins, Color)


@dataclass(frozen=True, eq=False)
class OwnColours:
    """shares (bins,): of each colour in what is the thing's own, 1 in all. pixels: how many told them."""

    shares: FloatArray
    pixels: float

    def joined(self, other: "OwnColours") -> "OwnColours":
        """Return what two views tell, each by the pixels it has."""
        pixels = self.pixels + other.pixels
        return OwnColours((self.pixels * self.shares + other.pixels * other.shares) / pixels, pixels)

    def common(self, other: "OwnColours") -> float:
        """Return how much they have in common, 0 to 1: the Bhattacharyya coefficient of the shares."""
        return float(np.sqrt(self.shares * other.shares).sum())


def own_colours(picture: Color, box: PixelBox) -> OwnColours | None:
    """Return the colours of what fills `box` that are not those around it; None where it has hardly any."""
    bins = colour_bins(picture)
    shares = _INSIDE, _BESIDE, _AROUND
    inside, beside, around = (counts_of(cut_to(bins, box.inner(each))) for each in shares)
    own = np.maximum(shares_of(inside) - shares_of(around - beside), 0.0)
    told = float(own.sum())
    return OwnColours(own / told, told * float(inside.sum())) if told > _LEAST_OWN else None


def evidence(picture: Color, colours: OwnColours) -> Values:
    """Return (height, width) log odds, -2 to 2, that a pixel is the thing's and not any of the picture."""
    bins = colour_bins(picture)
    odds = np.log((colours.shares + _RARE) / (shares_of(counts_of(bins)) + _RARE))
    return np.clip(odds, -_STRONGEST, _STRONGEST).astype(np.float32)[bins]


def has_colours(picture: Color, colours: OwnColours, box: PixelBox) -> bool:
    """Tell whether what is in `box` looks rather like the thing than like any of the picture."""
    return bool(cut_to(evidence(picture, colours), box).mean() > 0.0)


def colour_bins(picture: Color) -> Bins:
    """Return (height, width) the colour of each pixel, as a bin."""
    lightness, a, b = cv2.split(cv2.cvtColor(picture, cv2.COLOR_BGR2LAB).astype(np.intp))
    return np.asarray((lightness * _SHADES // 256 * _HUES + a * _HUES // 256) * _HUES + b * _HUES // 256)


def cut_to(values: T, box: PixelBox) -> T:
    """Return what of values (height, width, ...) lies in a box, one pixel at least."""
    height, width = values.shape[:2]
    left, top = min(max(0, round(box.left)), width - 1), min(max(0, round(box.top)), height - 1)
    return values[top : max(top, round(box.bottom)) + 1, left : max(left, round(box.right)) + 1]


def counts_of(bins: Bins) -> FloatArray:
    """Return (bins,) how many pixels have each colour."""
    return np.bincount(bins.ravel(), minlength=_SHADES * _HUES**2).astype(np.float64)


def shares_of(counts: FloatArray, alike: tuple[float, float, float] = _ALIKE) -> FloatArray:
    """Return the share of each colour, of counts (bins,), with what looks alike: one sigma [bins]."""
    cube = gaussian_filter(counts.reshape(_SHADES, _HUES, _HUES), alike, mode="nearest")
    return np.asarray(cube.ravel() / max(1.0, float(counts.sum())))
