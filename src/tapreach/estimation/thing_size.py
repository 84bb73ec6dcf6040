"""From outlines of a thing on upright rasters to its size and its middle.

As with a drawn box (`box_extent`), the outline lies somewhat behind the located point: the sides by about a
quarter of the width, the far rim of a top that is seen from above by most of it. Where it ends near the floor
it stands on it: there the picture does not tell one from the other.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.estimation.box_extent import BoxExtent
from tapreach.estimation.thing_raster import UprightRaster
from tapreach.geometry.finite import FloatArray

_WIDEST_ROWS = 0.85
"""A thing is as wide as this share of its rows do not exceed."""
_SIDES, _RIM = 0.28, 0.8
_RIM_SD = 0.4
"""How far behind the point sides and the rim of a top lie, in widths (see `box_extent`)."""
_ON_FLOOR = 0.03
"""What ends lower stands on the floor [m]."""
_FOOT_BAND = 0.012
_AGREE_WIDTH, _AGREE_SHARE, _AGREE_MIDDLE = 0.007, 0.08, 0.006
_EDGE_SD, _HEIGHT_SD, _SHAPE_SD = 0.002, 0.006, 0.03
_DEPTH_SD = 0.35
"""Of the way from the front to the middle, in half widths."""


@dataclass(frozen=True)
class Silhouette:
    """What one view shows of a thing [m]: width across its line of sight, its middle's way to the left of the
    located point, top and foot above the floor. cell: of the raster. rim_sd: of the top.
    """

    width: float
    leftwards: float
    top: float
    foot: float
    cell: float
    rim_sd: float
    ahead: FloatArray
    left: FloatArray


@dataclass(frozen=True)
class FusedSize:
    """Size [m] with one sigma each, foot above the floor, middle in the world (3,) with covariance (3, 3)."""

    width: float
    width_sd: float
    height: float
    height_sd: float
    foot: float
    axis_in_world: FloatArray
    axis_cov_in_world: FloatArray


def silhouette(
    raster: UprightRaster, axis: int, top_row: int, half_widths: npt.NDArray[np.intp], point_height_sd: float
) -> Silhouette:
    """Return the silhouette of an outline: its axis's column, its first row, half widths row by row [cells].

    point_height_sd: how well the point's height above the floor is known, one sigma [m].
    """
    kept = half_widths[: max(3, len(half_widths) - int(_FOOT_BAND / raster.cell))]
    flat = 2.0 * float(np.quantile(kept, _WIDEST_ROWS)) * raster.cell
    behind = 1.0 + _SIDES * flat / raster.distance
    width = flat * behind
    rise = raster.height_of(top_row - 0.5) - float(raster.origin[2])
    rim = (_RIM if rise < 0.0 else _SIDES) * width / raster.distance
    bottom = raster.height_of(top_row + len(half_widths) - 0.5)
    return Silhouette(
        width,
        raster.leftwards(axis) * behind,
        float(raster.origin[2]) + rise * (1.0 + rim),
        0.0 if bottom < _ON_FLOOR + 2.0 * point_height_sd else bottom,
        raster.cell,
        abs(rise) / raster.distance * _RIM_SD * width,
        raster.ahead,
        raster.left,
    )


def silhouette_of_box(extent: BoxExtent, point: FloatArray, point_height_sd: float) -> Silhouette:
    """Return the silhouette by a drawn box, for the located `point` (3,) [m]."""
    left_top, right_top, right_bottom, _ = extent.corners_in_world
    left = (left_top - right_top) / np.linalg.norm(left_top - right_top)
    ahead = np.array([left[1], -left[0], 0.0])
    bottom = float(right_bottom[2])
    foot = 0.0 if bottom < _ON_FLOOR + 2.0 * point_height_sd else bottom
    leftwards = float(((left_top + right_top) / 2.0 - point) @ left)
    return Silhouette(extent.width, leftwards, foot + extent.height, foot, _EDGE_SD, 0.0, ahead, left)


def agreeing(seen: Sequence[Silhouette]) -> tuple[Silhouette, ...]:
    """Return the two that agree best on width and middle; none where no two do."""
    pairs = [(a, b) for i, a in enumerate(seen) for b in seen[:i]]
    best = min(pairs, key=lambda pair: _disagreement(*pair), default=None)
    return best if best is not None and _disagreement(*best) <= 1.0 else ()


def _disagreement(a: Silhouette, b: Silhouette) -> float:
    """Return by how much two differ; 1 is the most that passes for the same."""
    width = max(_AGREE_WIDTH, _AGREE_SHARE * max(a.width, b.width))
    middle = max(_AGREE_MIDDLE, _AGREE_SHARE * max(a.width, b.width))
    return max(abs(a.width - b.width) / width, abs(a.leftwards - b.leftwards) / middle)


def fused(
    seen: Sequence[Silhouette], point: FloatArray, point_cov: FloatArray, relative_sd: float
) -> FusedSize:
    """Return the mean of silhouettes, at least one, about the located `point` (3,) [m] with covariance (3, 3)
    [m²].

    relative_sd: of the distance at which they were seen.
    """
    width, leftwards, top = (
        float(np.mean([getattr(each, name) for each in seen])) for name in ("width", "leftwards", "top")
    )
    foot = min(each.foot for each in seen)
    height = max(top - foot, seen[0].cell)
    edge = max(_EDGE_SD, *(each.cell for each in seen))
    width_sd = math.hypot(edge, _half_spread(seen, "width"), (relative_sd + _SHAPE_SD) * width)
    height_sd = math.hypot(
        _HEIGHT_SD, _half_spread(seen, "top"), relative_sd * height, float(np.mean([s.rim_sd for s in seen]))
    )
    middle_sd = math.hypot(edge, _half_spread(seen, "leftwards"))
    ahead, left = seen[0].ahead, seen[0].left
    half = width / 2.0
    depth = math.sqrt(max(half**2 - leftwards**2, (0.4 * half) ** 2))
    axis = point + leftwards * left + depth * ahead
    axis[2] = foot + height / 2.0
    spread = np.diag([0.0, 0.0, height_sd**2 / 4.0])
    for direction, sd in ((left, middle_sd), (ahead, _DEPTH_SD * half)):
        spread += sd**2 * np.outer(direction, direction)
    return FusedSize(width, width_sd, height, height_sd, foot, axis, point_cov + spread)


def _half_spread(seen: Sequence[Silhouette], name: str) -> float:
    values = [float(getattr(each, name)) for each in seen]
    return (max(values) - min(values)) / 2.0
