"""Finds a thing again by its own colours, where from this side it looks otherwise than in any picture kept.

Sought is a box of its size that has its colours inside and not around it, in the region where it may be.
"""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.image_io import Color
from tapreach.vision.own_colours import OwnColours, evidence, own_colours

_WITHIN = 3.0
"""Sigmas around the expected place in which it is sought."""
_INSIDE, _GAP, _STRIP = 0.85, 1.1, 0.4
"""Of the box, half of it each: what counts as inside; where the strips beside it begin; how wide they are."""
_LEAST_HALF, _LEAST_STRIP = 4.0, 2.0
"""[px]"""
_LEAST, _CLEARLY = 1.5, 0.4
"""Log odds by which its inside differs from what is around it, and by how much more than anywhere else."""
LEAST_COMMON = 0.3
"""So much its colours there have in common with those known (Bhattacharyya's coefficient): a white cup is not
a red one with white dots, but a ball may show other stripes.
"""
_PER_SIGMA = 0.15
"""What a squared sigma off the expected place takes from them."""
_APART = 1.5
"""What overlaps the best place, in half sizes, is no other place."""
_AGAINST = -1.0
"""Log odds below which the inside speaks against the thing, whatever is around it: of a white cup with blue
dots, on a bright floor, most does."""
_NOWHERE = -9.0


@dataclass(frozen=True, eq=False)
class ExpectedBox:
    """Where a thing should be in a picture: its middle, pixel (2,), with covariance (2, 2) [px²], half its
    width and half its height [px], and how many times as large it may be seen.
    """

    pixel: FloatArray
    covariance: FloatArray
    half_width: float
    half_height: float
    scales: tuple[float, ...] = (1.0,)

    def less_sure(self, times: float) -> "ExpectedBox":
        """Return it with a place known so many times worse."""
        return replace(self, covariance=times**2 * self.covariance)

    def box_at(self, pixel: FloatArray) -> PixelBox:
        """Return the box around the thing with its middle at a pixel (2,)."""
        u, v = map(float, pixel)
        across, down = max(self.half_width, _LEAST_HALF), max(self.half_height, _LEAST_HALF)
        return PixelBox(u - across, v - down, u + across, v + down)


def box_by_colours(
    picture: Color, colours: OwnColours, there: ExpectedBox, least_common: float = LEAST_COMMON
) -> PixelBox | None:
    """Return the box around the thing; None where nothing within the expected region has its colours, at
    least `least_common` of them, and ends where it should, or two places do. Its middle lies on the picture,
    not always all of it.
    """
    columns, rows, off = _places(picture, there)
    if not rows.size or not columns.size:
        return None
    total = np.asarray(cv2.integral(evidence(picture, colours), sdepth=cv2.CV_64F), np.float64)
    half = np.array([there.half_width, there.half_height])
    halves = [np.maximum(_LEAST_HALF, scale * half) for scale in there.scales]
    fits = np.stack([_fit(total, columns, rows, *each) for each in halves])
    fits = np.where(off > _WITHIN**2, _NOWHERE, fits - _PER_SIGMA * off)
    k, row, column = np.unravel_index(int(np.argmax(fits)), fits.shape)
    best, (across, down) = float(fits[k, row, column]), halves[k]
    u, v = float(columns[column]), float(rows[row])
    same = (np.abs(rows - v) < _APART * down)[:, None] & (np.abs(columns - u) < _APART * across)[None, :]
    if best < _LEAST or best - float(np.where(same, _NOWHERE, fits).max()) < _CLEARLY:
        return None
    box = PixelBox(u - across, v - down, u + across, v + down)
    seen = own_colours(picture, box)
    return box if seen is not None and seen.common(colours) > least_common else None


def _places(picture: Color, there: ExpectedBox) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the columns and rows of the region in which it is sought, and (rows, columns) the squared
    distance from the expected place in sigmas.
    """
    reach = _WITHIN * np.sqrt(np.diag(there.covariance))
    (left, top), (right, bottom) = np.ceil(there.pixel - reach), np.floor(there.pixel + reach)
    columns = np.arange(max(0.0, left), min(picture.shape[1] - 1.0, right) + 1.0)
    rows = np.arange(max(0.0, top), min(picture.shape[0] - 1.0, bottom) + 1.0)
    away = np.stack(np.meshgrid(columns, rows), axis=-1) - there.pixel
    off = np.einsum("...i,ij,...j->...", away, np.linalg.inv(there.covariance), away)
    return columns, rows, np.asarray(off)


def _fit(total: FloatArray, columns: FloatArray, rows: FloatArray, across: float, down: float) -> FloatArray:
    """Return how much more the inside of a box around each place speaks for the thing than what is around it.

    One of its four sides may look as it does; what does not speak for it is not found.
    """
    wide = max(_LEAST_STRIP, 2.0 * _STRIP * across)

    def mean(left: float, right: float, top: float, bottom: float) -> FloatArray:
        return _means(total, columns, rows, (left, right), (top, bottom))

    a, d = _INSIDE * across, _INSIDE * down
    beside, above = _GAP * across, _GAP * down
    inside = mean(-a, a, -d, d)
    around = [
        mean(-beside - wide, -beside, -d, d),
        mean(beside, beside + wide, -d, d),
        mean(-a, a, -above - wide, -above),
        mean(-a, a, above, above + wide),
    ]
    return np.where(inside > _AGAINST, inside - np.sort(around, axis=0)[-2], _NOWHERE)


def _means(
    total: FloatArray,
    columns: FloatArray,
    rows: FloatArray,
    across: tuple[float, float],
    down: tuple[float, float],
) -> FloatArray:
    """Return the mean over a rectangle about each place, of what is on the picture of it; 0 where nothing
    is. total: the integral.
    """
    height, width = total.shape[0] - 1, total.shape[1] - 1
    left, right = (np.clip(np.round(columns + each + 0.5), 0, width).astype(int) for each in across)
    top, bottom = (np.clip(np.round(rows + each + 0.5), 0, height).astype(int) for each in down)
    sums = (
        total[np.ix_(bottom, right)]
        - total[np.ix_(top, right)]
        - total[np.ix_(bottom, left)]
        + total[np.ix_(top, left)]
    )
    area = (bottom - top)[:, None] * (right - left)[None, :]
    return np.asarray(sums / np.maximum(area, 1))
