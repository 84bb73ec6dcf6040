"""What of a thing the robot's camera sees from a place on the floor."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.obstacle import into, out_of

MARGIN = 0.04
"""What nears the edge of the picture by this share of its width does not count as well seen."""
_AROUND = np.linspace(0.0, 2.0 * math.pi, 12, endpoint=False)
_HEIGHTS = 21


@dataclass(frozen=True)
class Upright:
    """A thing as an upright cylinder: middle (2,) on the floor, radius, foot and top [m]."""

    middle: FloatArray
    radius: float
    foot: float
    top: float

    def rims(self) -> FloatArray:
        """Return places (n, 3) all around its foot and its top."""
        ring = self.middle + self.radius * np.column_stack([np.cos(_AROUND), np.sin(_AROUND)])
        rims = [np.column_stack([ring, np.full(len(ring), height)]) for height in (self.foot, self.top)]
        return np.concatenate(rims)

    def front_line(self, seen_from: FloatArray) -> FloatArray:
        """Return places (n, 3) from foot to top along the side that faces `seen_from` (2,)."""
        off = seen_from - self.middle
        distance = float(np.linalg.norm(off))
        front = self.middle + off * (min(self.radius, distance) / max(distance, 1e-9))
        heights = np.linspace(self.foot, self.top, _HEIGHTS)
        return np.column_stack([np.tile(front, (_HEIGHTS, 1)), heights])


@dataclass(frozen=True)
class Sight:
    """The camera where it is mounted: camera_from_base as a rotation (3, 3) and an offset (3,)."""

    camera: Camera
    rotation: FloatArray
    offset: FloatArray

    @classmethod
    def of(cls, description: RobotDescription) -> "Sight":
        """Return the camera of the robot's file, mounted as it says."""
        matrix = description.camera.mount.base_from_camera().inv().as_matrix()
        return cls(description.camera.model(), matrix[:3, :3], matrix[:3, 3])

    def is_whole(self, thing: Upright, base: PlanarPose) -> bool:
        """Tell whether all of it is in the picture, with a margin; `base` in the thing's frame."""
        return bool(self._well_seen(thing.rims(), base).all())

    def is_in_picture(self, place: npt.ArrayLike, base: PlanarPose) -> bool:
        """Tell whether a place (3,) is in the picture, with a margin."""
        return bool(self._well_seen(np.array([place], dtype=np.float64), base)[0])

    def seen_heights(self, thing: Upright, base: PlanarPose) -> tuple[float, float] | None:
        """Return from which to which height its front is in the picture [m]; None where it is not at all."""
        line = thing.front_line(np.array([base.x, base.y]))
        seen = line[self._well_seen(line, base), 2]
        return (float(seen.min()), float(seen.max())) if len(seen) else None

    def place_on_floor(self, base: PlanarPose) -> FloatArray:
        """Return above which place (2,) of the floor the camera is, the base standing at `base` [m]."""
        return np.asarray(out_of(base, (-self.rotation.T @ self.offset)[None, :2])[0])

    def _well_seen(self, points: FloatArray, base: PlanarPose) -> npt.NDArray[np.bool_]:
        in_base = np.column_stack([into(base, points[:, :2]), points[:, 2]])
        seen = self.camera.project(in_base @ self.rotation.T + self.offset)
        margin = MARGIN * self.camera.size.width
        last = np.array([self.camera.size.width, self.camera.size.height]) - 1.0
        inside = ((seen.pixels >= margin) & (seen.pixels <= last - margin)).all(axis=1)
        return np.asarray(seen.is_valid & inside)
