"""Corners spread evenly over the whole picture, away from given boxes."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from tapreach.vision.flow import Points
from tapreach.vision.image_io import Gray

_MOST = 220
_APART = 14
"""Distance of corners from each other [px]."""
_QUALITY = 0.01
_LEAST_STRENGTH = 2e-4
"""Smaller eigenvalue of the gradients below which a corner is noise (cv2.cornerMinEigenVal, 3 by 3)."""


@dataclass(frozen=True)
class Box:
    """A part of the picture [px], edges included."""

    left: float
    top: float
    right: float
    bottom: float


def halved(picture: Gray) -> Gray:
    """Return the picture at half its size: a quarter of the work, and less noise."""
    return np.asarray(cv2.resize(picture, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), np.uint8)


def in_half(places: Points) -> Points:
    """Return where places (n, 2) of a picture lie in the halved one."""
    # The middle of the halved picture's pixel i is the middle between the pixels 2 i and 2 i + 1.
    return np.asarray((places - 0.5) / 2.0, dtype=np.float32)


def in_whole(places: Points) -> Points:
    """Return where places (n, 2) of a halved picture lie in the whole one."""
    return np.asarray(2.0 * places + 0.5, dtype=np.float32)


def spread_corners(half: Gray, masked: Sequence[Box] = ()) -> Points:
    """Return up to 220 corners (n, 2) [px of the whole picture], none inside the boxes `masked` of it.

    half: the picture at half its size, see `halved`.
    """
    mask = np.full(half.shape, 255, np.uint8)
    for box in masked:
        top, bottom = max(0, int(box.top / 2.0)), max(0, int(box.bottom / 2.0) + 1)
        left, right = max(0, int(box.left / 2.0)), max(0, int(box.right / 2.0) + 1)
        mask[top:bottom, left:right] = 0
    found = cv2.goodFeaturesToTrack(half, _MOST, _QUALITY, _APART / 2.0, mask=mask)
    if found is None:
        return np.zeros((0, 2), np.float32)
    places = found.reshape(-1, 2)
    columns, rows = places.round().astype(int).T
    is_strong = cv2.cornerMinEigenVal(half, 3)[rows, columns] > _LEAST_STRENGTH
    return in_whole(places[is_strong])
