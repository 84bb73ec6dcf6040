"""What is known of the poses' errors: a linear map from independent unit normals (docs/estimation.md, 3)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.nuisances import NuisancePriors, focal_columns, mount_columns
from tapreach.estimation.observation import Observation, matrix_of_mount
from tapreach.estimation.odometry_noise import OdometryNoise, chain_errors, covariance_root, with_next_errors
from tapreach.geometry.finite import FloatArray, not_negative
from tapreach.geometry.gaussian import require_covariance
from tapreach.geometry.pose import skew

_EXACT = NuisancePriors()


@dataclass(frozen=True)
class MountNoise:
    """One sigma of the camera's mount, shared by all views: each coordinate [m] and each angle [rad]."""

    position_sigma: float = 0.0
    angle_sigma: float = 0.0

    def __post_init__(self) -> None:
        for name in ("position_sigma", "angle_sigma"):
            object.__setattr__(self, name, not_negative(name, getattr(self, name)))


@dataclass(frozen=True, eq=False)
class PoseErrors:
    """Errors of the bases by_base (n, 6, k) and, with the same independent unit normals, of the mount they
    share, by_mount (6, k): right perturbation, (translation, rotation).
    """

    by_base: FloatArray
    by_mount: FloatArray


Motion = OdometryNoise | PoseErrors | npt.ArrayLike | None


@dataclass(frozen=True)
class CameraErrors:
    """What is wrong with the cameras, per independent unit normal.

    by_normal: (n, 6, k), error of the pose: right perturbation, (translation, rotation). by_mount: (6, k),
    the part of the last camera's that is the mount's. by_pixel: (n, 2, k) [px], error of the picture; None
    where there is none.
    """

    by_normal: FloatArray
    by_mount: FloatArray
    by_pixel: FloatArray | None = None

    @cached_property
    def moves_the_first(self) -> bool:
        """True where the first camera has errors."""
        return bool(self.by_normal[0].any())


def camera_errors(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None = None,
    nuisances: NuisancePriors | None = None,
    tap_bias_px: float = 0.0,
) -> CameraErrors:
    """Return equation (3): what one sigma of every independent cause does to every camera.

    motion: None for exact poses; OdometryNoise for poses along a drive in the order given; or the
    covariance of the base poses, joint (6n, 6n) or of independent poses (n, 6, 6); or PoseErrors.
    """
    none = np.zeros((0, 1, 4, 4))
    return camera_errors_with_next(
        observations, motion, mount_noise, none, nuisances=nuisances, tap_bias_px=tap_bias_px
    )


def camera_errors_with_next(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    world_from_bases: FloatArray,
    next_pixels: FloatArray | None = None,
    nuisances: NuisancePriors | None = None,
    tap_bias_px: float = 0.0,
) -> CameraErrors:
    """Return the errors (n + c v, 6, k) of the observations' cameras, and of the last one on c next ways.

    world_from_bases (c, v, 4, 4): v places along each way; next_pixels (c v, 2): where the target will be
    seen there. The ways share normals: use at most one of them with the others.
    """
    priors = nuisances or _EXACT
    mounts = [view.base_from_camera for view in observations]
    mounts += [mounts[-1]] * (world_from_bases.shape[0] * world_from_bases.shape[1])
    of_cameras = _inverse_adjoints(mounts) @ _base_errors(observations, motion, world_from_bases, priors)
    with_poses = np.zeros_like(of_cameras[-1])
    if isinstance(motion, PoseErrors):
        with_poses[:, : motion.by_mount.shape[1]] = motion.by_mount
        of_cameras = of_cameras + with_poses
    of_mount = _mount_errors(mounts, mount_noise, priors)
    of_picture = _picture_errors(observations, next_pixels, len(mounts), priors.focal_scale, tap_bias_px)
    if of_mount is None and of_picture is None:
        return CameraErrors(of_cameras, with_poses)
    of_mount = np.zeros((len(mounts), 6, 0)) if of_mount is None else of_mount
    of_picture = np.zeros((len(mounts), 2, 0)) if of_picture is None else of_picture
    parts = [of_cameras, of_mount, np.zeros((len(mounts), 6, of_picture.shape[2]))]
    by_mount = np.concatenate([with_poses, of_mount[-1], parts[2][-1]], axis=1)
    by_pixel = None
    if of_picture.shape[2]:
        unmoved = np.zeros((len(mounts), 2, by_mount.shape[1] - of_picture.shape[2]))
        by_pixel = np.concatenate([unmoved, of_picture], axis=2)
    return CameraErrors(np.concatenate(parts, axis=2), by_mount, by_pixel)


def _mount_errors(
    mounts: Sequence[RigidTransform], mount_noise: MountNoise | None, priors: NuisancePriors
) -> FloatArray | None:
    parts = []
    if mount_noise is not None:
        sigmas = np.repeat([mount_noise.position_sigma, mount_noise.angle_sigma], 3)
        of_mount = np.diag(sigmas)[:, sigmas > 0.0]
        parts.append(np.broadcast_to(of_mount, (len(mounts), *of_mount.shape)))
    if priors.moves_the_mount:
        parts.append(mount_columns(np.array([mount.as_matrix() for mount in mounts]), priors))
    return np.concatenate(parts, axis=2) if parts else None


def _picture_errors(
    observations: Sequence[Observation],
    next_pixels: FloatArray | None,
    count: int,
    focal_scale: float,
    tap_bias_px: float,
) -> FloatArray | None:
    parts = []
    if focal_scale > 0.0:
        pixels = np.array([(view.pixel.u, view.pixel.v) for view in observations])
        every = pixels if next_pixels is None else np.concatenate([pixels, next_pixels])
        cameras = [view.camera for view in observations]
        cameras += [cameras[-1]] * (count - len(cameras))
        parts.append(focal_columns(cameras, every, focal_scale))
    if tap_bias_px > 0.0:
        parts.append(np.broadcast_to(tap_bias_px * np.eye(2), (count, 2, 2)))
    return np.concatenate(parts, axis=2) if parts else None


def _base_errors(
    observations: Sequence[Observation], motion: Motion, world_from_bases: FloatArray, priors: NuisancePriors
) -> FloatArray:
    if not priors.scales_the_wheels:
        return _motion_errors(observations, motion, world_from_bases)
    if isinstance(motion, OdometryNoise):
        motion = replace(
            motion,
            advance_scale=float(np.hypot(motion.advance_scale, priors.distance_scale)),
            turn_scale=float(np.hypot(motion.turn_scale, priors.turn_scale)),
        )
        return _motion_errors(observations, motion, world_from_bases)
    scales = OdometryNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, priors.distance_scale, priors.turn_scale)
    parts = [_motion_errors(observations, each, world_from_bases) for each in (motion, scales)]
    return np.concatenate(parts, axis=2)


def _motion_errors(
    observations: Sequence[Observation], motion: Motion, world_from_bases: FloatArray
) -> FloatArray:
    count, (ways, length) = len(observations), world_from_bases.shape[:2]
    if motion is None:
        return np.zeros((count + ways * length, 6, 0))
    if isinstance(motion, OdometryNoise):
        return _odometry_errors(observations, motion, world_from_bases)
    known = _known_errors(motion, count)
    if ways == 0:
        return known
    last = known[-1] @ known[-1].T
    errors = np.zeros((count + ways * length, 6, known.shape[2] + 6 * length))
    errors[:count, :, : known.shape[2]] = known
    each = np.kron(np.eye(length), covariance_root(last)).reshape(length, 6, 6 * length)
    errors[count:, :, known.shape[2] :] = np.tile(each, (ways, 1, 1))
    return errors


def _odometry_errors(
    observations: Sequence[Observation], noise: OdometryNoise, world_from_bases: FloatArray
) -> FloatArray:
    given = matrices = np.array([view.base_matrix for view in observations])
    if len(world_from_bases):
        matrices = np.concatenate([given, world_from_bases.reshape(-1, 4, 4)])
    start, offsets = matrices[0, :3, :3], matrices[:, :3, 3] - matrices[0, :3, 3]
    ahead = matrices[:, :3, 0] @ start
    headings = np.arctan2(ahead[:, 1], ahead[:, 0])
    poses = offsets @ start
    poses[:, 2] = headings
    planar = chain_errors(poses[: len(given)], noise)
    if len(world_from_bases):
        coming = poses[len(given) :].reshape(*world_from_bases.shape[:2], 3)
        planar = with_next_errors(planar, poses[len(given) - 1], coming, noise)
    planar = planar[:, :, planar.any(axis=(0, 1))]
    errors = np.zeros((len(matrices), 6, planar.shape[2]))
    errors[:, :2], errors[:, 5] = planar[:, :2], planar[:, 2]
    return errors


def _known_errors(motion: PoseErrors | npt.ArrayLike, count: int) -> FloatArray:
    """Return (n, 6, k). Raises InputError for errors of another number of poses."""
    if not isinstance(motion, PoseErrors):
        return _covariance_errors(np.asarray(motion, dtype=np.float64), count)
    if len(motion.by_base) != count:
        raise InputError(f"pose errors of {len(motion.by_base)} poses; there are {count} views")
    return motion.by_base


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
    """Return (n, 6, 6): `_inverse_adjoint` of every mount, (6, 6) where, as mostly, there is but one."""
    if all(mount is mounts[0] for mount in mounts):
        return _inverse_adjoint(mounts[0])
    distinct = {id(each): each for each in mounts}
    adjoints = {key: _inverse_adjoint(mount) for key, mount in distinct.items()}
    return np.array([adjoints[id(mount)] for mount in mounts])


@lru_cache(maxsize=16)
def _inverse_adjoint(base_from_camera: RigidTransform) -> FloatArray:
    """Return (6, 6): a base's small motion as the camera on it makes it."""
    matrix = matrix_of_mount(base_from_camera)
    rotation = matrix[:3, :3]
    adjoint = np.zeros((6, 6))
    adjoint[:3, :3] = adjoint[3:, 3:] = rotation.T
    adjoint[:3, 3:] = -rotation.T @ skew(matrix[:3, 3])
    adjoint.flags.writeable = False
    return adjoint
