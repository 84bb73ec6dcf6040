"""From bearing and inverse depth to uncertain points in world and base (docs/estimation.md, 10)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.estimation.camera_matrices import CameraMatrices, homogeneous_points
from tapreach.estimation.map_solver import Solution
from tapreach.estimation.motion_prior import CameraErrors
from tapreach.estimation.small_rotations import backward_rotations, cross_matrices
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_TARGET_COLUMNS = [0, 1, 3]
_IDENTITY = np.eye(3)[None, None]


@dataclass(frozen=True)
class UncertainPoint:
    """A point (3,) [m] and its covariance (3, 3) [m²], first order."""

    point: FloatArray
    covariance: FloatArray

    def moved(self, matrix: FloatArray) -> "UncertainPoint":
        """Return it in another frame; matrix (4, 4): of the rigid transform there, taken as exact."""
        rotation = matrix[:3, :3]
        return UncertainPoint(rotation @ self.point + matrix[:3, 3], rotation @ self.covariance @ rotation.T)


@dataclass(frozen=True, eq=False)
class GivenInFrames:
    """The target in the world and in the base at the last observation, from elsewhere than a solution."""

    world: UncertainPoint
    base: UncertainPoint


@dataclass(frozen=True)
class _Place:
    """A point (3,) and its derivatives by (a, b, rho) (3, 3) and by z (3, k)."""

    point: FloatArray
    by_target: FloatArray
    by_normals: FloatArray

    def moved(self, matrix: FloatArray) -> "_Place":
        """Return it in another frame; matrix (4, 4): of the rigid transform there."""
        rotation = matrix[:3, :3]
        point = rotation @ self.point + matrix[:3, 3]
        return _Place(point, rotation @ self.by_target, rotation @ self.by_normals)

    def misplaced(self, errors: CameraErrors, normals: FloatArray) -> "_Place":
        """Return it once more moved by the mount's own error, which moves the camera on the base."""
        if not errors.by_mount.any():
            return self
        by_normals = self.by_normals + errors.by_mount[:3] - cross_matrices(self.point) @ errors.by_mount[3:]
        shift, turn = np.split(errors.by_mount @ normals, 2)
        back, _ = backward_rotations(turn)
        return _Place(back.T @ self.point + shift, self.by_target, by_normals)


@dataclass(frozen=True, eq=False)
class TargetInFrames:
    """The target in the world and in the base, computed when first asked for: many ask for neither.

    world_from_first, base_from_last (4, 4): poses of the first camera in the world, of the last on the base.
    target_covariance (3, 3): of (a, b, rho).
    """

    model: ViewModel
    solution: Solution
    target_covariance: FloatArray
    world_from_first: FloatArray
    base_from_last: FloatArray

    @cached_property
    def world(self) -> UncertainPoint:
        """The target in the frame of the poses given, held fixed by the first of them."""
        return self._uncertain(_in_first(self._cameras, self.solution.x).moved(self.world_from_first))

    @cached_property
    def base(self) -> UncertainPoint:
        """The target in the base at the last observation, which is what to drive by."""
        seen = _in_last(self._cameras, self.solution.x)
        on_base = seen.misplaced(self.model.errors, self.solution.x[3:])
        return self._uncertain(on_base.moved(self.base_from_last))

    @cached_property
    def _cameras(self) -> CameraMatrices:
        return self.model.cameras(self.solution.x[None])

    def _uncertain(self, place: _Place) -> UncertainPoint:
        """Return the place with what the errors of target and poses make of it: equation (7b)."""
        views = self.solution.views
        seen = views.by_errors[0] @ place.by_normals.T
        solved = views.weighed(seen).T
        direct = place.by_target - solved @ views.by_target[0]
        remaining = place.by_normals @ place.by_normals.T - solved @ seen
        covariance = direct @ self.target_covariance @ direct.T + remaining
        return UncertainPoint(place.point, np.asarray(covariance))


def _in_first(cameras: CameraMatrices, x: FloatArray) -> _Place:
    """Return the target in the nominal first camera."""
    homogeneous = homogeneous_points(x[None])
    shift, forth = (np.zeros(3), np.eye(3)) if cameras.first is None else (each[0] for each in cameras.first)
    matrix = np.column_stack([forth, shift])
    return _dehomogenised(matrix, cameras.in_first_by_normals(x[None, :3])[0], homogeneous[0])


def _in_last(cameras: CameraMatrices, x: FloatArray) -> _Place:
    homogeneous = homogeneous_points(x[None])
    if cameras.first is None:
        cameras = cameras.last()
    points = cameras.matrices @ homogeneous[0]
    by_normals = cameras.by_normals(_IDENTITY, points, x[None, :3])
    return _dehomogenised(cameras.matrices[0, -1], by_normals[0, -1], homogeneous[0])


def _dehomogenised(matrix: FloatArray, by_normals: FloatArray, homogeneous: FloatArray) -> _Place:
    inverse_depth = homogeneous[3]
    point = matrix @ homogeneous / inverse_depth
    by_target = matrix[:, _TARGET_COLUMNS] / inverse_depth
    by_target[:, 2] -= point / inverse_depth
    return _Place(point, by_target, by_normals / inverse_depth)
