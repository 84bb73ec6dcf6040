"""From points that stand up from the floor to obstacles: gathered on the floor, divided until all are small.

Only what faces the camera is seen. A thing is taken to be as deep as it is wide, up to a can's depth; walls
and furniture are lines as thick as that.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.standing_points import StandingPoints

NAME = "something"
_CELL = 0.02
_LEAST_IN_CELLS, _LEAST_IN_ALL = 1e-4, 3e-4
"""What stands is worth a look from so much area on, around a cell and in all [m²]."""
_LEAST_UPRIGHT = 0.01
"""What stands is seen over so much height at least [m]: a line on the floor is not."""
_LEAST_POINTS = 8
_LONGEST, _WIDEST, _THIN = 0.12, 0.14, 0.05
"""Parts deeper, or wider and not thin, are divided [m]."""
_LEAST_RADIUS, _MOST_RADIUS = 0.015, 0.04
_FRONT = 20.0
"""Percentile of the points' distances that is taken for the front."""
_LEAST_SPREAD, _MOST_SPREAD = 0.01, 0.02


def clustered(found: StandingPoints) -> list[Obstacle]:
    """Return obstacles that hold the points, each the size of a thing or a piece of something larger."""
    if len(found.points) < _LEAST_POINTS:
        return []
    cells = np.floor(found.points[:, :2] / _CELL).astype(np.int_)
    cells -= cells.min(axis=0) - 2
    areas = np.zeros(cells.max(axis=0) + 3)
    np.add.at(areas, (cells[:, 0], cells[:, 1]), found.areas)
    is_solid = ndimage.convolve(areas, np.ones((3, 3)), mode="constant") > _LEAST_IN_CELLS
    labels = np.asarray(ndimage.label(is_solid, np.ones((3, 3)))[0])
    of_points = labels[cells[:, 0], cells[:, 1]]
    parts = (found.where(of_points == label) for label in range(1, int(labels.max()) + 1))
    return [obstacle for part in parts if _is_upright(part) for obstacle in _divided(part)]


def _is_upright(part: StandingPoints) -> bool:
    heights = part.points[:, 2]
    return bool(part.areas.sum() > _LEAST_IN_ALL and np.ptp(heights) > _LEAST_UPRIGHT)


def _divided(part: StandingPoints) -> list[Obstacle]:
    if len(part.points) < _LEAST_POINTS:
        return []
    camera = np.median(part.cameras, axis=0)
    ahead = np.median(part.points[:, :2], axis=0) - camera
    ahead /= np.linalg.norm(ahead)
    axes = np.array([ahead, [-ahead[1], ahead[0]]])
    along, across = axes @ (part.points[:, :2] - camera).T
    near, far = np.percentile(along, [5, 95])
    right, left = np.percentile(across, [3, 97])
    deep, wide = far - near, left - right
    if deep > _LONGEST and deep >= wide:
        return _halves(part, along < (near + far) / 2.0)
    if wide > _WIDEST and deep > _THIN:
        return _halves(part, across < (left + right) / 2.0)
    radius = float(np.clip(wide / 2.0, _LEAST_RADIUS, _MOST_RADIUS))
    middle, half = (left + right) / 2.0, max(0.0, wide / 2.0 - radius)
    depth = float(np.percentile(along, _FRONT)) + radius
    ends = [camera + np.array([depth, middle + side]) @ axes for side in (-half, half)]
    spread = float(np.clip(np.median(part.spreads) / 2.0, _LEAST_SPREAD, _MOST_SPREAD))
    return [Obstacle(NAME, np.asarray(ends[0]), np.asarray(ends[1]), radius, spread)]


def _halves(part: StandingPoints, is_first: NDArray[np.bool_]) -> list[Obstacle]:
    return [*_divided(part.where(is_first)), *_divided(part.where(~is_first))]
