"""Projection matrices of cameras whose poses have errors, and how a target moves in them (docs, 3 and 4)."""

from dataclasses import dataclass

import numpy as np

from tapreach.estimation.motion_prior import CameraErrors
from tapreach.estimation.small_rotations import backward_rotations, cross_matrices
from tapreach.geometry.finite import FloatArray

_STILL = np.eye(3)[None, None]


@dataclass(frozen=True)
class CameraMatrices:
    """m guesses of n cameras; 1 in the place of m where all are alike.

    matrices (m, n, 3, 4): to each camera from homogeneous points of the nominal first one, (4) and (5).
    back (m, n or 1, 3, 3): exp(-phi). slopes, of this shape: right Jacobians at phi. into_view (n, 3, 3):
    nominal rotations. by_normal (n, 6, k): errors per unit normal. first: None where the first camera has no
    errors, else its position (m, 3) and rotation (m, 3, 3) in the nominal one.
    """

    matrices: FloatArray
    back: FloatArray
    slopes: FloatArray
    into_view: FloatArray
    by_normal: FloatArray
    first: tuple[FloatArray, FloatArray] | None

    def by_normals(self, slopes: FloatArray, points: FloatArray, targets: FloatArray) -> FloatArray:
        """Return slopes · d points / d z: (m, n, r, k).

        slopes (m, n, r, 3): of anything by the points. points (m, n, 3): the targets in the cameras.
        targets (m, 3): the same as (a, b, rho) in the nominal first one.
        """
        if self.by_normal.shape[2] == 0:
            return np.zeros((*points.shape[:2], slopes.shape[-2], 0))
        by_error = np.empty((*points.shape, 6))
        by_error[..., :3] = targets[:, 2, None, None, None] * -self.back
        np.matmul(cross_matrices(points), self.slopes, out=by_error[..., 3:])
        by_x = slopes @ by_error @ self.by_normal
        if self.first is not None:
            onward = slopes @ (self.back @ self.into_view)
            by_x += onward @ self.in_first_by_normals(targets)[:, None]
        return np.asarray(by_x)

    def last(self) -> "CameraMatrices":
        """Return only the last camera; the first must be without errors."""
        return CameraMatrices(
            self.matrices[:, -1:],
            self.back[:, -1:],
            self.slopes[:, -1:],
            self.into_view[-1:],
            self.by_normal[-1:],
            None,
        )

    def in_first_by_normals(self, targets: FloatArray) -> FloatArray:
        """Return d (the targets (m, 3) in the nominal first camera, times rho) / d z: (m, 3, k)."""
        errors = self.by_normal[0]
        shifted = targets[:, 2, None, None] * errors[:3]
        if self.first is None:
            return np.asarray(shifted)
        forth = self.first[1] @ cross_matrices(homogeneous_points(targets)[:, :3]) @ self.slopes[:, 0]
        return np.asarray(shifted - forth @ errors[3:])


def camera_matrices(nominal: FloatArray, errors: CameraErrors, normals: FloatArray) -> CameraMatrices:
    """Return the cameras for normals (m, k), given the nominal ones (n, 3, 4) and their errors."""
    count, views = len(normals), len(nominal)
    if np.count_nonzero(normals) == 0:
        return _nominal_cameras(nominal, errors)
    moved = (normals @ errors.by_normal.reshape(6 * views, -1).T).reshape(count, views, 6)
    back, slopes = backward_rotations(moved[..., 3:])
    first = None
    if errors.moves_the_first:
        first = moved[:, 0, :3], back[:, 0].mT
        ahead = nominal @ _as_poses(*first)[:, None]
    else:
        ahead = np.array([nominal] * count)
    ahead[..., 3] -= moved[..., :3]
    return CameraMatrices(back @ ahead, back, slopes, nominal[:, :, :3], errors.by_normal, first)


def homogeneous_points(targets: FloatArray) -> FloatArray:
    """Return equation (2), (a, b, 1, rho): (m, 4), for targets (m, 3 or more)."""
    points = np.empty((len(targets), 4))
    points[:, :2], points[:, 2], points[:, 3] = targets[:, :2], 1.0, targets[:, 2]
    return points


def _nominal_cameras(nominal: FloatArray, errors: CameraErrors) -> CameraMatrices:
    """Return the cameras where no pose has an error."""
    first = (np.zeros((1, 3)), _STILL[0]) if errors.moves_the_first else None
    return CameraMatrices(nominal[None], _STILL, _STILL, nominal[:, :, :3], errors.by_normal, first)


def _as_poses(shifts: FloatArray, rotations: FloatArray) -> FloatArray:
    poses = np.zeros((len(shifts), 4, 4))
    poses[:, :3, :3], poses[:, :3, 3], poses[:, 3, 3] = rotations, shifts, 1.0
    return poses
