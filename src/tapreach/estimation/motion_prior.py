"""What is known of the poses' errors: a linear map from independent unit normals (docs/estimation.md, 3)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise, chain_errors, covariance_root, with_next_errors
from tapreach.geometry.finite import FloatArray, not_negative
from tapreach.geometry.gaussian import require_covariance
from tapreach.geometry.pose import skew

Motion = OdometryNoise | npt.ArrayLike | None
_PLANAR_ROWS = [0, 1, 5]


@dataclass(frozen=True)
class MountNoise:
    """One sigma of the camera's mount, shared by all views: each coordinate [m] and each angle [rad]."""

    position_sigma: float = 0.0
    angle_sigma: float = 0.0

    def __post_init__(self) -> None:
        for name in ("position_sigma", "angle_sigma"):
            object.__setattr__(self, name, not_negative(name, getattr(self, name)))


@dataclass(frozen=True)
class CameraErrors:
    """Errors of the cameras' poses per independent unit normal: right perturbation, (translation, rotation).

    by_normal: (n, 6, k), the whole error. by_mount: (6, k), the part that is the mount's.
    """

    by_normal: FloatArray
    by_mount: FloatArray


def camera_errors(
    observations: Sequence[Observation], motion: Motion, mount_noise: MountNoise | None
) -> CameraErrors:
    """Return equation (6): what one sigma of every independent cause does to every camera.

    motion: None for exact poses; OdometryNoise for poses along a drive in the order given; or the
    covariance of the base poses, joint (6n, 6n) or of independent poses (n, 6, 6).
    """
    return camera_errors_with_next(observations, motion, mount_noise, np.zeros((0, 1, 4, 4)))


def camera_errors_with_next(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    world_from_bases: FloatArray,
) -> CameraErrors:
    """Return the errors (n + c v, 6, k) of the observations' cameras, and of the last one on c next ways.

    world_from_bases (c, v, 4, 4): v places along each way. The ways share normals: use at most one of them
    with the others.
    """
    mounts = [view.base_from_camera for view in observations]
    mounts += [mounts[-1]] * (world_from_bases.shape[0] * world_from_bases.shape[1])
    of_cameras = _inverse_adjoints(mounts) @ _base_errors(observations, motion, world_from_bases)
    if mount_noise is None:
        return CameraErrors(of_cameras, np.zeros((6, of_cameras.shape[2])))
    sigmas = np.repeat([mount_noise.position_sigma, mount_noise.angle_sigma], 3)
    of_mount = np.diag(sigmas)[:, sigmas > 0.0]
    spread = np.broadcast_to(of_mount, (len(mounts), *of_mount.shape))
    by_mount = np.concatenate([np.zeros((6, of_cameras.shape[2])), of_mount], axis=1)
    return CameraErrors(np.concatenate([of_cameras, spread], axis=2), by_mount)


def _base_errors(
    observations: Sequence[Observation], motion: Motion, world_from_bases: FloatArray
) -> FloatArray:
    count, (ways, length) = len(observations), world_from_bases.shape[:2]
    if motion is None:
        return np.zeros((count + ways * length, 6, 0))
    if isinstance(motion, OdometryNoise):
        return _odometry_errors(observations, motion, world_from_bases)
    covariance = np.asarray(motion, dtype=np.float64)
    known = _covariance_errors(covariance, count)
    if ways == 0:
        return known
    last = np.asarray(covariance[-1] if covariance.ndim == 3 else covariance[-6:, -6:])
    errors = np.zeros((count + ways * length, 6, known.shape[2] + 6 * length))
    errors[:count, :, : known.shape[2]] = known
    each = np.kron(np.eye(length), covariance_root(last)).reshape(length, 6, 6 * length)
    errors[count:, :, known.shape[2] :] = np.tile(each, (ways, 1, 1))
    return errors


def _odometry_errors(
    observations: Sequence[Observation], noise: OdometryNoise, world_from_bases: FloatArray
) -> FloatArray:
    given = np.array([view.world_from_base.as_matrix() for view in observations])
    matrices = np.concatenate([given, world_from_bases.reshape(-1, 4, 4)])
    start, offsets = matrices[0, :3, :3], matrices[:, :3, 3] - matrices[0, :3, 3]
    ahead = matrices[:, :3, 0] @ start
    headings = np.arctan2(ahead[:, 1], ahead[:, 0])
    poses = np.column_stack([(offsets @ start)[:, :2], headings])
    planar = chain_errors(poses[: len(given)], noise)
    if len(world_from_bases):
        coming = poses[len(given) :].reshape(*world_from_bases.shape[:2], 3)
        planar = with_next_errors(planar, poses[len(given) - 1], coming, noise)
    used = np.any(planar != 0.0, axis=(0, 1))
    errors = np.zeros((len(matrices), 6, int(used.sum())))
    errors[:, _PLANAR_ROWS] = planar[:, :, used]
    return errors


def _covariance_errors(covariance: FloatArray, count: int) -> FloatArray:
    if covariance.shape == (count, 6, 6):
        joint = np.zeros((6 * count, 6 * count))
        for i, block in enumerate(covariance):
            joint[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = block
        covariance = joint
    if covariance.shape != (6 * count, 6 * count):
        raise InputError(
            f"pose covariance has shape {covariance.shape}; for {count} views it must be "
            f"({6 * count}, {6 * count}) for joint or ({count}, 6, 6) for independent errors"
        )
    root = covariance_root(require_covariance("pose covariance", covariance, 6 * count))
    return root[:, np.any(root != 0.0, axis=0)].reshape(count, 6, -1)


def _inverse_adjoints(mounts: Sequence[RigidTransform]) -> FloatArray:
    """Return (n, 6, 6): `_inverse_adjoint` of every mount; mostly there is but one."""
    adjoints = {key: _inverse_adjoint(mount) for key, mount in {id(each): each for each in mounts}.items()}
    return np.array([adjoints[id(mount)] for mount in mounts])


def _inverse_adjoint(base_from_camera: RigidTransform) -> FloatArray:
    """Return (6, 6): a base's small motion as the camera on it makes it."""
    matrix = base_from_camera.as_matrix()
    rotation = matrix[:3, :3]
    adjoint = np.zeros((6, 6))
    adjoint[:3, :3] = adjoint[3:, 3:] = rotation.T
    adjoint[:3, 3:] = -rotation.T @ skew(matrix[:3, 3])
    return adjoint
