"""What in a picture stands where the thing does, by how other views of it moved.

Each cell of a raster may show what lies at the thing's distance, or something else: the floor, or a plane
nearer or farther. A surface is likely where the other views, warped by its homography, look like the first. A
cell that some views do not see for the thing before it is compared with the other half of them (Kang,
Szeliski, Chai, "Handling occlusions in dense multi-view stereo", 2001); once the thing's outline is known,
with those that are free of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Color, Gray

Cells = NDArray[np.float32]
Mask = NDArray[np.bool_]

_WINDOW = 5
"""Cells compared together."""
_MOST = 60
"""Larger differences tell no more [grey levels of 255, roots of brightness]."""
_UNSEEN = 255
_NOISE = 3.0
"""A difference of the costs that is worth one unit of evidence."""
_STRONGEST = 4.0
_TELLS_APART = 0.12
"""From this difference of distance on, floor and thing move differently enough [share of the distance]."""
_INNER = 6
"""So far inside an outline [cells] nothing behind can be seen."""
_GREY = np.full((1, 3), 1.0 / 3.0, np.float32)


@dataclass(frozen=True)
class Surface:
    """One surface that cells may show: where it can be seen, homographies from the raster to each view."""

    is_possible: Mask
    to_views: tuple[FloatArray, ...]


@dataclass(frozen=True)
class _Compared:
    """Differences (views, rows, columns), and where on the thing's raster views see each cell."""

    is_possible: Mask
    differences: Gray
    to_thing: tuple[FloatArray, ...]


class Parallax:
    """Evidence that cells show the thing.

    picture: of the raster; views: pictures of the others. at_thing: surfaces about the thing's distance, the
    first of them the raster's own. elsewhere: all others. floor_shares (rows, columns): see UprightRaster.
    is_seen (rows, columns): where the raster's own picture reaches.
    """

    def __init__(
        self,
        picture: Color,
        views: Sequence[Color],
        at_thing: Sequence[Surface],
        elsewhere: Sequence[Surface],
        floor_shares: FloatArray,
        is_seen: Mask,
    ) -> None:
        self._is_seen = is_seen
        raster = at_thing[0].to_views
        self._elsewhere = [_compared(picture, views, surface, raster) for surface in elsewhere]
        own = [_compared(picture, views, surface, raster).differences for surface in at_thing]
        self._at_thing = np.fmin.reduce([_cost_of_best_half(each) for each in own])
        self._weight = np.clip(np.abs(floor_shares - 1.0) / _TELLS_APART, 0.0, 1.0).astype(np.float32)
        self.evidence = self._evidence(None)
        """(rows, columns): above zero for the thing, below for something else; about 0 where it cannot be
        told.
        """

    def without(self, outlined: Mask) -> Cells:
        """Return the evidence when `outlined` hides what is behind it from other views."""
        evidence = self._evidence(outlined)
        kernel = np.ones((2 * _INNER + 1, 2 * _INNER + 1), np.uint8)
        inner = cv2.erode(outlined.astype(np.uint8), kernel) > 0
        evidence[inner] = np.maximum(evidence, self.evidence)[inner]
        return evidence

    def _evidence(self, outlined: Mask | None) -> Cells:
        cost = np.full(self._at_thing.shape, np.nan, np.float32)
        wide = None if outlined is None else _grown(outlined)
        for surface in self._elsewhere:
            differences = surface.differences if wide is None else _without_hidden(surface, wide)
            here = _cost_of_best_half(differences)
            here[~surface.is_possible] = np.nan
            cost = np.fmin(cost, here)
        strength = np.clip((cost - self._at_thing) / _NOISE, -_STRONGEST, _STRONGEST)
        evidence = np.nan_to_num(strength) * self._weight
        evidence[~self._is_seen] = 0.0
        return np.asarray(evidence, dtype=np.float32)


def _grown(mask: Mask) -> Gray:
    return np.asarray(cv2.dilate(mask.astype(np.uint8), np.ones((_WINDOW, _WINDOW), np.uint8)), np.uint8)


def warped(picture: Color, to_picture: FloatArray, shape: tuple[int, ...]) -> tuple[Color, Mask]:
    """Return a picture on a raster of `shape` (rows, columns), and where it reaches."""
    full = np.full(picture.shape[:2], 255, np.uint8)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (shape[1], shape[0])
    there = cv2.warpPerspective(picture, to_picture, size, flags=flags)
    return np.asarray(there, np.uint8), np.asarray(
        cv2.warpPerspective(full, to_picture, size, flags=flags) == 255
    )


def _compared(
    picture: Color, views: Sequence[Color], surface: Surface, raster: Sequence[FloatArray]
) -> _Compared:
    differences = []
    for view, to_view in zip(views, surface.to_views, strict=True):
        there, reaches = warped(view, to_view, picture.shape)
        difference = np.minimum(cv2.transform(cv2.absdiff(there, picture), _GREY), _MOST)
        difference = cv2.blur(difference, (_WINDOW, _WINDOW))
        difference[~reaches] = _UNSEEN
        differences.append(difference)
    to_thing = tuple(
        np.linalg.inv(to_raster) @ to_view
        for to_raster, to_view in zip(raster, surface.to_views, strict=True)
    )
    return _Compared(surface.is_possible, np.array(differences, np.uint8), to_thing)


def _without_hidden(surface: _Compared, outlined: Gray) -> Gray:
    rows, columns = outlined.shape
    flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
    differences = surface.differences.copy()
    for difference, to_thing in zip(differences, surface.to_thing, strict=True):
        difference[cv2.warpPerspective(outlined, to_thing, (columns, rows), flags=flags) > 0] = _UNSEEN
    return differences


def _cost_of_best_half(differences: Gray) -> Cells:
    """Return the mean of the smaller half of what is seen; nan where nothing is."""
    ordered = np.sort(differences, axis=0)
    is_seen = ordered < _UNSEEN
    count = is_seen.sum(axis=0)
    sums = np.cumsum(np.where(is_seen, ordered, 0).astype(np.float32), axis=0)
    half = np.maximum((count + 1) // 2, 1)
    mean = np.take_along_axis(sums, half[None] - 1, axis=0)[0] / half
    return np.where(count > 0, mean, np.float32(np.nan)).astype(np.float32)
