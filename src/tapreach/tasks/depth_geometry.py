"""Where a tapped patch falls in other frames at every supposed depth, and how well the poses tell."""

import math

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import pose_to_matrix, skew
from tapreach.robot.config import RobotDescription
from tapreach.tasks.straightening import Straightened


class DepthGeometry:
    """The first of the sightings is the tapped one. half, step: the patch's [samples], [px per sample].

    The patch is taken as a small plane that faces the tapped camera at depth 1 / rho.
    """

    def __init__(
        self, straight: Straightened, description: RobotDescription, place: Pixel, half: int, step: float
    ) -> None:
        self._camera = description.camera.model()
        self._errors = straight.errors
        self._half = half
        self._base_from_camera = pose_to_matrix(straight.base_from_camera)
        bases = [_matrix(sighting.world_from_base) for sighting in straight.sightings]
        first = bases[0] @ self._base_from_camera
        self._steps = [np.linalg.inv(base @ self._base_from_camera) @ first for base in bases]
        """camera_from_tapped_camera of each view."""
        reach = half * step
        corners = self._camera.unproject(
            [[place.u, place.v], [place.u + reach, place.v], [place.u, place.v + reach]]
        )
        self._corners = corners / corners[:, 2:]

    def warps(self, view: int, inverse_depths: FloatArray) -> FloatArray:
        """Return warps (m, 2, 3) from samples of the patch to pixels of a view; NaN behind its camera."""
        step = self._steps[view]
        turned = self._corners @ step[:3, :3].T
        points = turned + inverse_depths[:, None, None] * step[:3, 3]
        projection = self._camera.project(points.reshape(-1, 3))
        pixels = np.where(projection.is_valid[:, None], projection.pixels, np.nan).reshape(-1, 3, 2)
        centre, right, down = pixels.swapaxes(0, 1)
        return np.stack([(right - centre) / self._half, (down - centre) / self._half, centre], axis=2)

    def covariance(self, view: int, inverse_depth: float) -> FloatArray:
        """Return the covariance (2, 2) [px²] of where the place falls on a view, by what is not known of
        the poses and of the mount, to first order.
        """
        mount, step = self._base_from_camera, self._steps[view]
        first = self._corners[0] / inverse_depth
        seen = step[:3, :3] @ first + step[:3, 3]
        by_mount = step[:3, :3] @ _moved(self._errors.by_mount, first) - _moved(self._errors.by_mount, seen)
        on_base = mount[:3, :3] @ seen + mount[:3, 3]
        by_base = mount[:3, :3].T @ _moved(self._errors.by_base[view], on_base)
        _, by_point = self._camera.project_with_jacobian(seen[None])
        # The first pose is exact (Straightened.errors).
        root = by_point[0] @ (by_mount - by_base)
        return np.asarray(root @ root.T)


def _matrix(pose: PlanarPose) -> FloatArray:
    c, s = math.cos(pose.heading), math.sin(pose.heading)
    return np.array([[c, -s, 0.0, pose.x], [s, c, 0.0, pose.y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def _moved(errors: FloatArray, point: FloatArray) -> FloatArray:
    """Return how errors (6, k), translation and rotation, move a point (3,): (3, k)."""
    return np.asarray(errors[:3] - skew(point) @ errors[3:])
