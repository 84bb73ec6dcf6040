"""Views of a located thing as small evened pictures, and how planes lead from one of them to the next."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.later_pictures import LaterPicture
from tapreach.tasks.sighting import Sighting
from tapreach.vision.plane_sweep import Evened, evened_picture

COLUMNS = 214
"""Pictures are looked at with about so many columns: a thing 5 cm wide is 7 px wide at 1.2 m."""
_BASELINES = 0.07, 0.13, 0.22
_LEAST_BASELINE = 0.03
"""Ways between the views that are compared [m]."""
_SECOND_LOOK = 0.2
"""Way before the last view from which it is looked once more [m]."""
_LOOKING_ALIKE = math.cos(math.radians(28.0))
"""Views whose directions differ by more have too little in common."""
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class StandingView:
    """A picture; matrix (3, 3) from what is in front of the camera to its pixels, shifted so that a thing
    that was followed falls on where that was; world_from_camera (4, 4) [m].
    """

    picture: Evened
    matrix: FloatArray
    world_from_camera: FloatArray

    @property
    def place(self) -> FloatArray:
        """Where the camera is, (3,) [m]."""
        return self.world_from_camera[:3, 3]

    @property
    def ahead(self) -> FloatArray:
        """The direction (3,) in which the camera looks."""
        return self.world_from_camera[:3, 2]

    def directions(self, columns: NDArray[np.int_], rows: NDArray[np.int_]) -> FloatArray:
        """Return the lines of sight (n, 3) of pixels in the world, 1 m deep."""
        pixels = np.stack([columns, rows, np.ones(len(rows))])
        return np.asarray((self.world_from_camera[:3, :3] @ np.linalg.inv(self.matrix) @ pixels).T)

    def may_show_floor(self, farthest: float) -> NDArray[np.bool_]:
        """Return (rows, columns) where the floor would be nearer than `farthest` [m deep]."""
        height, width = self.picture.shape
        rows = np.arange(height)
        down = -self.directions(np.full(height, width // 2), rows)[:, 2]
        return np.repeat((down * farthest > self.place[2])[:, None], width, axis=1)

    def by_depths(self, other: "StandingView", inverse_depths: FloatArray) -> FloatArray:
        """Return homographies (n, 3, 3) to another view by planes that face this one."""
        return self._by_planes(other, np.array([0.0, 0.0, 1.0]), inverse_depths)

    def by_floors(self, other: "StandingView", heights: FloatArray) -> FloatArray:
        """Return homographies (n, 3, 3) to another view by level planes at heights [m] below the camera."""
        down = -self.world_from_camera[:3, :3].T @ _UP
        return self._by_planes(other, down, 1.0 / (self.place[2] - heights))

    def _by_planes(self, other: "StandingView", normal: FloatArray, inverse_ways: FloatArray) -> FloatArray:
        step = np.linalg.inv(other.world_from_camera) @ self.world_from_camera
        by_plane = step[:3, :3] + inverse_ways[:, None, None] * np.outer(step[:3, 3], normal)
        return np.asarray(other.matrix @ by_plane @ np.linalg.inv(self.matrix))


def standing_views(
    sightings: Sequence[Sighting | LaterPicture],
    base_from_camera: RigidTransform,
    point_in_world: FloatArray,
    jpegs: Mapping[int, bytes],
    description: RobotDescription,
) -> list[StandingView]:
    """Return the views of the sightings whose pictures are kept and whole, in order."""
    lens = description.camera.model()
    shrink = max(1, round(lens.size.width / COLUMNS))
    size = ImageSize(lens.size.width // shrink, lens.size.height // shrink)
    share = size.width / lens.size.width, size.height / lens.size.height
    centre = (lens.cx + 0.5) * share[0] - 0.5, (lens.cy + 0.5) * share[1] - 0.5
    pinhole = Camera(size, lens.fx * share[0], lens.fy * share[1], *centre)
    views = []
    for sighting in sightings:
        jpeg = jpegs.get(sighting.frame_id)
        picture = None if jpeg is None else evened_picture(jpeg, lens, pinhole)
        if picture is None:
            continue
        pose = sighting.world_from_base.to_rigid() * base_from_camera
        matrix = pinhole.matrix()
        if sighting.pixel is not None:
            off = pose.inv().apply(point_in_world)
            followed_to = lens.normalise([sighting.pixel.to_array()])[0]
            matrix[:2, 2] += np.diag(matrix)[:2] * (followed_to - off[:2] / off[2])
        views.append(StandingView(picture, matrix, pose.as_matrix()))
    return views


def references(views: Sequence[StandingView]) -> list[int]:
    """Return the views that are looked at: the last, the first, and one between."""
    last = len(views) - 1
    ways = [float(np.linalg.norm(view.place - views[last].place)) for view in views]
    between = int(np.argmin(np.abs(np.array(ways) - _SECOND_LOOK)))
    return list(dict.fromkeys([last, 0, between]))


def compared_with(views: Sequence[StandingView], reference: int) -> list[int]:
    """Return the views with which one is compared: at some way from it, and from each other,
    looking the same way."""
    ways = np.array([float(np.linalg.norm(view.place - views[reference].place)) for view in views])
    alike = [float(view.ahead @ views[reference].ahead) > _LOOKING_ALIKE for view in views]
    left = [i for i in range(len(views)) if ways[i] > _LEAST_BASELINE and alike[i]]
    chosen: list[int] = []
    for wanted in _BASELINES:
        if left:
            chosen.append(min(left, key=lambda i: abs(ways[i] - wanted)))
            left.remove(chosen[-1])
    return chosen
