"""An upright raster through a located point, and where its cells fall in every view.

Its plane faces one camera, the reference. A cell's line of sight from there may end on the plane, farther,
nearer or on the floor; for each of these surfaces one homography leads from the raster to the picture of
another view. Pixels are shifted so that the located point falls on where it was followed to: what is left of
the errors of poses and mount is the same for all that is near it.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray

HALF_WIDTH, ABOVE_FLOOR, BELOW_FLOOR = 0.2, 0.34, 0.03
"""How far the raster reaches to either side of the point, and above and below the floor [m]."""
_FINEST_CELL = 0.002
_LEAST_DISTANCE = 0.1
_LEAST_DOWN = 1e-5


@dataclass(frozen=True)
class PlacedView:
    """A view of a thing: pinhole camera, its pose, and where the located point was followed to, (2,) [px]
    with the lens's distortion removed.
    """

    camera: Camera
    world_from_camera: RigidTransform
    pixel: FloatArray


@dataclass(frozen=True)
class UprightRaster:
    """Cells [row, column] of `cell` [m] in the upright plane through `point` (3,) [m] that faces `origin`.

    ahead, left: unit vectors (3,) away from the origin and to its left, level. distance: from the origin's
    vertical to the plane [m]. (row, column): of the point. Row 0 is the topmost, column 0 the leftmost.
    """

    origin: FloatArray
    point: FloatArray
    ahead: FloatArray
    left: FloatArray
    distance: float
    cell: float
    rows: int
    columns: int
    row: int
    column: int

    @classmethod
    def facing(cls, view: PlacedView, point: FloatArray) -> "UprightRaster | None":
        """Return the raster through `point` (3,) [m] that faces a view; None nearer than 10 cm."""
        origin = view.world_from_camera.translation
        way = point - origin
        distance = math.hypot(way[0], way[1])
        if distance < _LEAST_DISTANCE:
            return None
        ahead = np.array([way[0], way[1], 0.0]) / distance
        cell = max(_FINEST_CELL, distance / view.camera.fx)
        half = int(HALF_WIDTH / cell)
        above = int((max(ABOVE_FLOOR, point[2] + 0.1) - point[2]) / cell)
        below = int(max(BELOW_FLOOR, point[2] + BELOW_FLOOR) / cell) + 1
        left = np.array([-ahead[1], ahead[0], 0.0])
        return cls(origin, point, ahead, left, distance, cell, above + below + 1, 2 * half + 1, above, half)

    def height_of(self, row: float) -> float:
        """Return the height above the floor of a row [m]."""
        return float(self.point[2]) + (self.row - row) * self.cell

    def row_at(self, height: float) -> int:
        """Return the row at a height above the floor [m], the last one below the raster."""
        return min(self.rows - 1, self.row + round((float(self.point[2]) - height) / self.cell))

    def leftwards(self, column: float) -> float:
        """Return how far a column lies to the left of the point [m]."""
        return (self.column - column) * self.cell

    def floor_shares(self) -> FloatArray:
        """Return (rows, columns) how far the lines of sight go to the floor, in ways to the raster; inf for
        none.
        """
        down = -np.broadcast_to(
            np.arange(self.rows)[:, None] * self._rays[2, 1] + self._rays[2, 2], (self.rows, self.columns)
        )
        return np.where(down > _LEAST_DOWN, float(self.origin[2]) / np.maximum(down, _LEAST_DOWN), math.inf)

    def to_plane(self, view: PlacedView, share: float) -> FloatArray:
        """Return the homography (3, 3) from (column, row) to the view's pixels (u, v), for what lies `share`
        of the way to the raster from the origin, on a parallel plane.
        """
        rotation, translation = _camera_from_world(view)
        points = share * self._rays
        points = points + np.outer(self.origin, [0.0, 0.0, 1.0])
        return self._pixels(view, rotation @ points + np.outer(translation, [0.0, 0.0, 1.0]))

    def to_floor(self, view: PlacedView) -> FloatArray:
        """Return the same for the floor; meaningless above the horizon."""
        rotation, translation = _camera_from_world(view)
        up = self._rays[2]
        points = np.outer(self.origin, up) - self.origin[2] * self._rays
        return self._pixels(view, -(rotation @ points + np.outer(translation, up)))

    def _pixels(self, view: PlacedView, in_camera: FloatArray) -> FloatArray:
        rotation, translation = _camera_from_world(view)
        matrix = view.camera.matrix()
        seen = matrix @ (rotation @ self.point + translation)
        shift = np.eye(3)
        shift[:2, 2] = view.pixel - seen[:2] / seen[2]
        return np.asarray(shift @ matrix @ in_camera)

    @property
    def _rays(self) -> FloatArray:
        """Ways (3, 3) from the origin to the cell (column, row, 1)."""
        across, down = -self.left * self.cell, np.array([0.0, 0.0, -self.cell])
        first = self.point - self.origin - self.column * across - self.row * down
        return np.stack([across, down, first], axis=1)


def _camera_from_world(view: PlacedView) -> tuple[FloatArray, FloatArray]:
    rotation = view.world_from_camera.rotation.as_matrix().T
    return rotation, -rotation @ view.world_from_camera.translation
