"""Rigid transforms: scipy's RigidTransform used as it is, with the few things it lacks.

`point_in_world = world_from_camera.apply(point_in_camera)`; `world_from_camera = world_from_base *
base_from_camera`; `camera_from_world = world_from_camera.inv()`. Tangent vectors are ordered (translation,
rotation) and perturb on the right, in the body frame (docs/conventions.md).
"""

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite, finite_array

# Columns are the camera's axes (right, down, forward) in base axes (forward, left, up), for a level camera.
_BASE_FROM_LEVEL_CAMERA = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
_SWAPPED = [3, 4, 5, 0, 1, 2]


def pose_from_matrix(matrix: npt.ArrayLike) -> RigidTransform:
    """Return the transform of a 4 × 4 matrix.

    Raises InputError where it is not rigid to 1e-4: rotation not orthonormal, mirrored, or last row not
    (0, 0, 0, 1). Smaller rounding in the rotation is projected away.
    """
    given = finite_array("pose matrix", matrix, (4, 4))
    if not np.allclose(given[3], [0.0, 0.0, 0.0, 1.0], atol=1e-9):
        raise InputError(f"last row of the pose matrix is {given[3].tolist()}; it must be [0, 0, 0, 1]")
    rotation = given[:3, :3]
    error = float(np.abs(rotation.T @ rotation - np.eye(3)).max())
    if error > 1e-4:
        raise InputError(
            f"rotation of the pose matrix is off orthonormal by {error:.2g}; at most 1e-4 is right"
        )
    if np.linalg.det(rotation) < 0.0:
        raise InputError("rotation of the pose matrix mirrors (determinant -1); it must have determinant +1")
    return RigidTransform.from_components(given[:3, 3], Rotation.from_matrix(rotation))


def pose_to_matrix(pose: RigidTransform) -> FloatArray:
    """Return the transform as a 4 × 4 matrix."""
    return np.asarray(pose.as_matrix(), dtype=np.float64)


def pose_exp(tangent: npt.ArrayLike) -> RigidTransform:
    """Return the transform of a tangent vector (6,): (translation [m], rotation [rad])."""
    return RigidTransform.from_exp_coords(finite_array("tangent", tangent, (6,))[_SWAPPED])


def pose_log(pose: RigidTransform) -> FloatArray:
    """Return the tangent vector (6,) whose `pose_exp` is `pose`; rotation of less than pi."""
    return np.asarray(pose.as_exp_coords(), dtype=np.float64)[_SWAPPED]


def perturbed(pose: RigidTransform, tangent: npt.ArrayLike) -> RigidTransform:
    """Return `pose` moved by `tangent` (6,) in its own body frame: pose · exp(tangent)."""
    return pose * pose_exp(tangent)


def camera_mount(
    position_in_base: npt.ArrayLike, pitch: float = 0.0, yaw: float = 0.0, roll: float = 0.0
) -> RigidTransform:
    """Return base_from_camera for a camera at `position_in_base` (3,) [m].

    Without angles [rad] it looks level along the heading. Positive pitch looks down, positive yaw looks
    left, positive roll leans to the right. Applied in the order yaw, pitch, roll about the moved axes.
    """
    angles = [finite("yaw", yaw), finite("pitch", pitch), finite("roll", roll)]
    turned = Rotation.from_euler("ZYX", angles)
    rotation = turned * Rotation.from_matrix(_BASE_FROM_LEVEL_CAMERA)
    return RigidTransform.from_components(finite_array("position_in_base", position_in_base, (3,)), rotation)


def skew(vectors: FloatArray) -> FloatArray:
    """Return the matrices (..., 3, 3) of the cross product with vectors (..., 3)."""
    matrices = np.zeros((*vectors.shape, 3))
    matrices[..., 2, 1], matrices[..., 0, 2], matrices[..., 1, 0] = (
        vectors[..., 0],
        vectors[..., 1],
        vectors[..., 2],
    )
    matrices -= np.swapaxes(matrices, -1, -2)
    return matrices


def right_jacobians(rotation_vectors: FloatArray) -> FloatArray:
    """Return (n, 3, 3) J with exp(r + dr) = exp(r) exp(J dr) to first order, for rotation vectors (n, 3).

    Source: Solà, Deray and Atchuthan, "A micro Lie theory for state estimation in robotics", eq. 143.
    """
    cross = skew(rotation_vectors)
    angle = np.linalg.norm(rotation_vectors, axis=1)[:, None, None]
    safe = np.where(angle < 0.02, 1.0, angle)
    # Series where the closed form would divide by nearly zero.
    first = np.where(angle < 0.02, 0.5 - angle**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(angle < 0.02, 1.0 / 6.0 - angle**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    return np.asarray(np.eye(3) - first * cross + second * (cross @ cross))
