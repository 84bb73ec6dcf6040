"""Where the targets fall in a frame: computed once per frame, travelling with its pixels."""

import json
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera, Projection
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import confidence_ellipse
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import CameraSection
from tapreach.tasks.target import Target

SPHERE_POINTS = 24
BEFORE_CAMERA = 0.05
"""Nearer to the camera's plane nothing is drawn [m]."""


def _great_circles() -> FloatArray:
    """Points on the unit sphere along its three great circles, (3 * SPHERE_POINTS, 3)."""
    angles = np.linspace(0.0, 2.0 * np.pi, SPHERE_POINTS, endpoint=False)
    c, s, zero = np.cos(angles), np.sin(angles), np.zeros(SPHERE_POINTS)
    circles = [np.stack(axes, axis=1) for axes in ((c, s, zero), (c, zero, s), (zero, c, s))]
    return np.concatenate(circles)


_ON_SPHERE = _great_circles()


@dataclass(frozen=True, slots=True)
class Mark:
    """A target's position, the corners of its box, and the surface of its 95 % region, in the world.

    points_in_world: (1 + corners + n, 3); corners: 4, or 0 where no size is known.
    """

    target_id: int
    points_in_world: FloatArray
    state: str
    corners: int = 0

    @classmethod
    def of(cls, target: Target) -> "Mark | None":
        """Return what is to be drawn of a target; None while it has no position."""
        if target.point_in_world is None:
            return None
        parts = [target.point_in_world[None, :]]
        size = target.extent.size if target.extent is not None else None
        if size is not None:
            parts.append(size.corners_in_world)
        if target.point_cov_in_world is not None:
            region = confidence_ellipse(target.point_cov_in_world)
            surface = (_ON_SPHERE * region.half_axes) @ region.directions.T
            parts.append(target.point_in_world + surface)
        state = "followed" if target.is_following else "predicted"
        return cls(target.target_id, np.concatenate(parts), state, 4 if size is not None else 0)


class MarkerProjection:
    """Projects marks into the robot's camera."""

    def __init__(self, section: CameraSection) -> None:
        self._camera: Camera = section.model()
        self._camera_from_base: RigidTransform = section.mount.base_from_camera().inv()

    def meta(
        self,
        world_from_base: PlanarPose | None,
        marks: list[Mark],
        path_in_world: Sequence[FloatArray] = (),
        plan_in_world: Sequence[FloatArray] = (),
    ) -> bytes:
        """Return the JSON that travels with a frame captured at `world_from_base` (None: not known).

        path_in_world, plan_in_world: lines (n, 3) of the move that is being made, and of the plan to fetch.
        """
        meta: dict[str, object] = {"base": None, "markers": []}
        if world_from_base is not None:
            meta["base"] = [world_from_base.x, world_from_base.y, world_from_base.heading]
            meta["markers"] = self._markers(world_from_base, marks) if marks else []
            if path_in_world:
                meta["path"] = [self._line(world_from_base, line) for line in path_in_world]
            if plan_in_world:
                meta["plan"] = [self._line(world_from_base, line) for line in plan_in_world]
        return json.dumps(meta, separators=(",", ":")).encode()

    def _line(self, world_from_base: PlanarPose, points_in_world: FloatArray) -> list[list[float]]:
        """Return a line's pixels, from where it comes before the camera on."""
        camera_from_world = self._camera_from_base * world_from_base.to_rigid().inv()
        points = camera_from_world.apply(points_in_world)
        pixels = self._camera.project(points[points[:, 2] > BEFORE_CAMERA]).pixels
        return [[round(float(u), 1), round(float(v), 1)] for u, v in pixels]

    def _markers(self, world_from_base: PlanarPose, marks: list[Mark]) -> list[dict[str, object]]:
        """All marks go through the camera at once: this runs between frames, in the event loop."""
        points_in_world = np.concatenate([mark.points_in_world for mark in marks])
        camera_from_world = self._camera_from_base * world_from_base.to_rigid().inv()
        projection = self._camera.project(camera_from_world.apply(points_in_world))
        markers, start = [], 0
        for mark in marks:
            end = start + len(mark.points_in_world)
            # Behind the camera there is nowhere to draw it.
            if projection.is_valid[start]:
                region = slice(start + 1 + mark.corners, end)
                outline = _hull(projection.pixels[region][projection.is_valid[region]])
                box = _box(projection, slice(start + 1, start + 1 + mark.corners))
                markers.append(_marker(mark, projection, start, outline) | {"box": box})
            start = end
        return markers


def _marker(mark: Mark, projection: Projection, row: int, region: list[list[float]]) -> dict[str, object]:
    u, v = projection.pixels[row]
    return {
        "target_id": mark.target_id,
        "u": round(float(u), 2),
        "v": round(float(v), 2),
        "inside": bool(projection.is_inside[row]),
        "region": region,
        "state": mark.state,
    }


def _box(projection: Projection, rows: slice) -> list[list[float]]:
    """Return the corners; none where one of them is behind the camera."""
    if not np.all(projection.is_valid[rows]):
        return []
    return [[round(float(u), 1), round(float(v), 1)] for u, v in projection.pixels[rows]]


def _hull(pixels: FloatArray) -> list[list[float]]:
    if len(pixels) < 3:
        return []
    hull = cv2.convexHull(pixels.astype(np.float32)).reshape(-1, 2)
    return [[round(float(u), 1), round(float(v), 1)] for u, v in hull]
