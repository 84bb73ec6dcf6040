"""What the wheels say of how the camera moved between two pictures, and how wrong that may be."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.estimation.small_rotations import backward_rotations
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import skew

PLANAR_ROWS = [0, 1, 5]
"""x, y and heading among translation and rotation."""
_ROCKING = 0.002
"""Pitch and roll of a chassis on its wheels, one sigma of the difference between two stops [rad]."""
_SLIP_LEAST, _SLIP_OF_WAY = np.array([0.01, 0.005]), np.array([0.5, 0.15])
"""One sigma of x, y where wheels slip: in any step [m], and for each metre that they turned."""
_SLIP_HEADING = 0.2
"""And of the heading, for wheels that slip one more than the other [rad]."""


@dataclass(frozen=True)
class CameraStep:
    """The pose of the second camera in the first, by odometry, with its errors.

    by_wheels (6, k), by_mount (6, m): error per independent unit normal, (translation, rotation), right
    perturbation. turn_axis: (3,) up, in the second camera.
    """

    first_from_second: RigidTransform
    by_wheels: FloatArray
    by_mount: FloatArray
    mount_root: FloatArray
    """(6, m): the mount's own error per unit normal."""
    turn_axis: FloatArray
    second_camera_from_base: FloatArray
    """(6, 6): a small motion of the second base as its camera makes it."""
    slip_sigmas: FloatArray
    """(3,): `slip_sigmas` of the base's step."""

    @cached_property
    def rotation(self) -> FloatArray:
        """(3, 3): that of first_from_second."""
        return np.asarray(self.first_from_second.rotation.as_matrix())

    @cached_property
    def translation(self) -> FloatArray:
        """(3,) [m]: that of first_from_second."""
        return np.asarray(self.first_from_second.translation)

    @cached_property
    def by_normal(self) -> FloatArray:
        """All errors, (6, k + m)."""
        return np.concatenate([self.by_wheels, self.by_mount], axis=1)

    @property
    def turn_sd(self) -> float:
        """One sigma of the turn by the wheels alone [rad]."""
        return float(np.linalg.norm(self.turn_axis @ self.by_normal[3:]))

    def with_slip(self) -> "CameraStep":
        """Return the same step for wheels that may have slipped: hardly anything is known of it."""
        planar = np.zeros((6, 3))
        planar[PLANAR_ROWS] = np.diag(self.slip_sigmas)
        return replace(self, by_wheels=self.second_camera_from_base @ planar)

    def moved(self, normals: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return rotations (..., 3, 3) and translations (..., 3) of the step with errors `normals`."""
        errors = normals @ self.by_normal.T
        back, _ = backward_rotations(errors[..., 3:])
        translations = self.translation + errors[..., :3] @ self.rotation.T
        return self.rotation @ np.swapaxes(back, -1, -2), translations


def camera_step(
    first_from_second_base: PlanarPose,
    noise: OdometryNoise,
    base_from_camera: RigidTransform,
    mount_noise: MountNoise | None = None,
) -> CameraStep:
    """Return what the odometry of a step, and the mount, say of the camera's motion."""
    step = first_from_second_base.to_rigid()
    first_from_second = base_from_camera.inv() * step * base_from_camera
    to_camera = inverse_adjoint(base_from_camera)
    planar = pose_errors([PlanarPose(), first_from_second_base], noise)[1]
    of_base = np.zeros((6, planar.shape[1] + 2))
    of_base[PLANAR_ROWS, :-2] = planar
    of_base[3, -2] = of_base[4, -1] = _ROCKING
    mount = mount_noise if mount_noise is not None else MountNoise()
    sigmas = np.diag(np.repeat([mount.position_sigma, mount.angle_sigma], 3))
    # A mount that is off displaces both cameras: what is left is the difference, seen from the second.
    of_mount = (np.eye(6) - inverse_adjoint(first_from_second)) @ sigmas
    up = np.asarray(base_from_camera.rotation.inv().apply([0.0, 0.0, 1.0]))
    slip = slip_sigmas(first_from_second_base)
    return CameraStep(first_from_second, to_camera @ of_base, of_mount, sigmas, up, to_camera, slip)


def slip_sigmas(step: PlanarPose) -> FloatArray:
    """Return one sigma (3,) of x, y [m] and heading [rad] of a step on which the wheels may have slipped:
    blocked ones turn and take the base nowhere.
    """
    way = math.hypot(step.x, step.y)
    return np.array([*(_SLIP_LEAST + way * _SLIP_OF_WAY), _SLIP_HEADING])


def inverse_adjoint(outer_from_inner: RigidTransform) -> FloatArray:
    """Return (6, 6): a small motion of `outer` as `inner`, fixed to it, makes it."""
    rotation = outer_from_inner.rotation.as_matrix()
    adjoint = np.zeros((6, 6))
    adjoint[:3, :3] = adjoint[3:, 3:] = rotation.T
    adjoint[:3, 3:] = -rotation.T @ skew(np.asarray(outer_from_inner.translation))
    return adjoint
