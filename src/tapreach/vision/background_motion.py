"""The same places of the whole picture in two frames, followed through the frames in between.

Corners spread over the picture, carried from frame to frame by KLT forth and back, and fitted at last to the
frame they were taken from, so that errors do not add up. Nothing is known here of poses: what moves on its
own is left out as far as it breaks the epipolar geometry of the rest.

Source: Shi and Tomasi 1994; Kalal, Mikolajczyk and Matas, "Forward-backward error", ICPR 2010.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray
from tapreach.vision.background_corners import Box, halved, in_half, in_whole, spread_corners
from tapreach.vision.flow import Points, carried
from tapreach.vision.image_io import Gray

_WINDOW = (15, 15)
_LEVELS = 3
_CARRY = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 0.03)
_FIT = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 30, 0.003)
_FORTH_AND_BACK = 0.5
"""[px of the halved picture]."""
_FIT_BACK = 0.3
_FIT_REACH = 3.0
"""A place fitted to its first frame lies this near to where it was carried, or is another [px]."""
_EPIPOLAR = 1.5
_FEWEST = 15
_FAR_MOVED = 90.0
"""Percentile: what is far away hardly moves against the rest."""


class BackgroundQuality(StrEnum):
    """Whether there is a background to go by."""

    GOOD = "good"
    POOR = "poor"


@dataclass(frozen=True, eq=False)
class BackgroundPairs:
    """Pixels (n, 2) of the same places in the first frame and now; none when POOR, and why."""

    quality: BackgroundQuality
    reason: str
    first: FloatArray
    now: FloatArray


class BackgroundTracker:
    """Follows the background of a first picture. Feed it pictures in the order of time, with `follow`.

    masked: boxes of the picture to stay away from, such as the robot's own arm and what moves.
    """

    def __init__(self, picture: Gray, masked: Sequence[Box] = ()) -> None:
        self._shape = picture.shape
        self._first = self._now = picture
        self._small = halved(picture)
        self._corners = spread_corners(self._small, masked)
        self._places = self._marked = self._corners.copy()
        self._shift = np.zeros(2, np.float32)
        self.begun_with = len(self._corners)
        """How many places there were at first."""

    def __len__(self) -> int:
        """How many places are still followed."""
        return len(self._corners)

    def follow(self, picture: Gray) -> None:
        """Carry the places to the next picture. Raises InputError for a picture of another size."""
        if picture.shape != self._shape:
            raise InputError(f"the picture has shape {picture.shape}; the first one had {self._shape}")
        before, self._small, self._now = self._small, halved(picture), picture
        if not len(self._corners):
            return
        places, is_kept = _carried(before, self._small, self._places, self._shift)
        is_kept &= _is_inside(places, self._shape)
        if np.any(is_kept):
            self._shift = np.median(places[is_kept] - self._places[is_kept], axis=0).astype(np.float32)
        self._corners, self._places = self._corners[is_kept], places[is_kept]
        self._marked = self._marked[is_kept]

    def mark(self) -> None:
        """Count `parted_px` from the newest picture on."""
        self._marked = self._places

    def parted_px(self) -> float | None:
        """Return how far places have moved apart since the mark [px]: what a tenth of them have at least
        moved otherwise than the whole picture. None where too few are left to tell.
        """
        if len(self._places) < _FEWEST:
            return None
        moved = self._places - self._marked
        apart = np.linalg.norm(moved - np.median(moved, axis=0), axis=1)
        return float(np.percentile(apart, _FAR_MOVED))

    def pairs(self) -> BackgroundPairs:
        """Return the places in the first picture and in the newest one."""
        if self.begun_with < _FEWEST:
            return _poor(f"the picture has little texture: {self.begun_with} corners")
        if len(self._corners) < _FEWEST:
            return _poor(f"lost nearly all of {self.begun_with} corners: it left the picture, or blur")
        fitted, is_kept = _fitted(self._first, self._now, self._corners, self._places)
        first, now = self._corners[is_kept], fitted[is_kept]
        if len(first) < _FEWEST:
            return _poor(f"only {len(first)} of {self.begun_with} corners still look as at first: blur?")
        is_kept = _moves_with_the_rest(first, now)
        first, now = first[is_kept], now[is_kept]
        if len(first) < _FEWEST:
            return _poor(f"only {len(first)} of {self.begun_with} corners move as one")
        return BackgroundPairs(BackgroundQuality.GOOD, "", first.astype(np.float64), now.astype(np.float64))


def _poor(reason: str) -> BackgroundPairs:
    return BackgroundPairs(BackgroundQuality.POOR, reason, np.zeros((0, 2)), np.zeros((0, 2)))


def _carried(before: Gray, now: Gray, places: Points, shift: Points) -> tuple[Points, NDArray[np.bool_]]:
    """Return where `places` (n, 2) of the whole picture have gone, seen in halved ones; and which hold."""
    start = in_half(places)
    forth, is_found = carried(before, now, start, start + shift / 2.0, _WINDOW, _LEVELS, _CARRY)
    back, is_back = carried(now, before, forth, start, _WINDOW, 1, _CARRY)
    is_kept = is_found & is_back & (np.linalg.norm(back - start, axis=1) < _FORTH_AND_BACK)
    return in_whole(forth), is_kept


def _fitted(first: Gray, now: Gray, corners: Points, places: Points) -> tuple[Points, NDArray[np.bool_]]:
    """Return where the corners' first look lies now (n, 2), starting from `places`; and which hold."""
    forth, is_found = carried(first, now, corners, places, _WINDOW, 0, _FIT)
    back, is_back = carried(now, first, forth, corners, _WINDOW, 0, _FIT)
    is_kept = is_found & is_back & (np.linalg.norm(back - corners, axis=1) < _FIT_BACK)
    return forth, is_kept & (np.linalg.norm(forth - places, axis=1) < _FIT_REACH)


def _is_inside(places: Points, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    edge = _WINDOW[0] // 2
    return np.asarray(
        np.all((places >= edge) & (places <= (shape[1] - 1 - edge, shape[0] - 1 - edge)), axis=1)
    )


def _moves_with_the_rest(first: Points, now: Points) -> NDArray[np.bool_]:
    """Tell which pairs (n,) obey the epipolar geometry of most; those of a turn alone obey any."""
    try:
        _, inliers = cv2.findFundamentalMat(first, now, cv2.USAC_MAGSAC, _EPIPOLAR, 0.999, 300)
    except cv2.error:
        # After a turn alone all of USAC may polish a model that it has not found; the older search does not.
        _, inliers = cv2.findFundamentalMat(first, now, cv2.FM_RANSAC, _EPIPOLAR, 0.999, 300)
    return np.zeros(len(first), np.bool_) if inliers is None else np.asarray(inliers.ravel() > 0)
