"""The same places of the whole picture in every one of a row of pictures.

Corners spread over the first picture, carried from each picture to the next by KLT forth and back. A place
that is lost once is left out of all: who compares the places over time wants the same ones all the time.

Source: Shi and Tomasi 1994; Kalal, Mikolajczyk and Matas, "Forward-backward error", ICPR 2010.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray
from tapreach.vision.background_corners import halved, in_half, in_whole, spread_corners
from tapreach.vision.flow import Points, carried
from tapreach.vision.image_io import Gray

_WINDOW = (15, 15)
_LEVELS = 4
_CRITERIA = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 15, 0.01)
_FORTH_AND_BACK = 0.5
"""[px of the halved picture]."""


@dataclass(frozen=True, eq=False)
class FollowedPlaces:
    """pixels: (pictures, places, 2) [px] of what was seen in all. begun_with: corners of the first one."""

    pixels: FloatArray
    begun_with: int


def followed_places(pictures: Sequence[Gray]) -> FollowedPlaces:
    """Return the places that all pictures show, given in the order of time.

    Raises InputError for no picture and for pictures of different sizes.
    """
    if not pictures or any(picture.shape != pictures[0].shape for picture in pictures):
        shapes = sorted({picture.shape for picture in pictures})
        raise InputError(f"pictures of the shapes {shapes}; there must be one shape, and a picture at least")
    small = [halved(picture) for picture in pictures]
    first = spread_corners(small[0])
    ways = [first]
    shift = np.zeros(2, np.float32)
    for before, now in pairwise(small):
        places, is_kept = _carried(before, now, ways[-1], shift)
        if np.any(is_kept):
            shift = np.median(places[is_kept] - ways[-1][is_kept], axis=0).astype(np.float32)
        ways = [way[is_kept] for way in ways] + [places[is_kept]]
    return FollowedPlaces(np.asarray(ways, dtype=np.float64), len(first))


def _carried(before: Gray, now: Gray, places: Points, shift: Points) -> tuple[Points, NDArray[np.bool_]]:
    """Return where `places` (n, 2) of the whole picture have gone, seen in halved ones; and which hold."""
    if not len(places):
        return places, np.zeros(0, np.bool_)
    start = in_half(places)
    forth, is_found = carried(before, now, start, start + shift / 2.0, _WINDOW, _LEVELS, _CRITERIA)
    back, is_back = carried(now, before, forth, start, _WINDOW, 1, _CRITERIA)
    is_kept = is_found & is_back & (np.linalg.norm(back - start, axis=1) < _FORTH_AND_BACK)
    return in_whole(forth), is_kept & _is_inside(forth, before.shape)


def _is_inside(places: Points, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    edge = _WINDOW[0] // 2
    last = (shape[1] - 1 - edge, shape[0] - 1 - edge)
    return np.asarray(np.all((places >= edge) & (places <= last), axis=1))
