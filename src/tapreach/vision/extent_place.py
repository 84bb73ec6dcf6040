"""Which place inside a drawn box to follow: the middle, or where there is more texture."""

import math
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import GOOD_SIGMA, patch_of_half
from tapreach.vision.warp import warp_at

Own = NDArray[np.bool_]

_MOSTLY = 0.5
_LEAST_HALF, _MOST_HALF = 6, 11
"""Half size of the patches compared [px]; as far as the box is large enough they lie inside it."""
_SHARE = 0.6
"""Places are looked for in this share of the box: nearer to its edges the patch sees what lies behind."""
_STEPS = (-1.0, -0.5, 0.0, 0.5, 1.0)
_PULL = 1.5
"""A place at the edge of the share searched must be so many times better, less one, than the middle."""


def place_to_follow(picture: Gray, box: PixelBox, own: Own | None = None) -> Pixel:
    """Return the place (u, v) well inside `box` that can be followed best, its middle where that is good.

    Nearer to the middle is better: there the thing is most surely what is seen. The box lies on the picture.
    own (height, width): what of the picture looks like the thing; around the place most of it does, if it
    does so anywhere.
    """
    middle = box.middle
    half = int(min(max(min(box.width, box.height) * 0.4, _LEAST_HALF), _MOST_HALF))
    if _is_own(own, middle, half) and _expected_sigma(picture, middle, half) <= GOOD_SIGMA:
        return middle
    across, down = _SHARE * box.width / 2.0, _SHARE * box.height / 2.0
    ways = sorted(product(_STEPS, _STEPS), key=lambda way: math.hypot(*way))
    places = [(Pixel(middle.u + x * across, middle.v + y * down), math.hypot(x, y)) for x, y in ways]
    places = [each for each in places if _is_own(own, each[0], half)] or places
    return min(
        places, key=lambda each: _expected_sigma(picture, each[0], half) * (1.0 + _PULL * each[1] ** 2)
    )[0]


def _is_own(own: Own | None, place: Pixel, half: int) -> bool:
    if own is None:
        return True
    u, v = round(place.u), round(place.v)
    around = own[max(0, v - half) : v + half + 1, max(0, u - half) : u + half + 1]
    return bool(around.size) and float(around.mean()) > _MOSTLY


def _expected_sigma(picture: Gray, place: Pixel, half: int) -> float:
    return patch_of_half(picture, warp_at(place.u, place.v), half).expected_sigma
