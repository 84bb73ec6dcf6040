"""A drive with everything known of it: wheels, mount, and what the background said of each step.

All errors of poses and mount are one linear map of unit normals (3); what each step's pictures say is a
Gaussian likelihood of such errors. Their product is the posterior of the normals, from which come corrected
poses, a corrected mount, and the map from new unit normals to the errors that are left. Source: Thrun,
Burgard and Fox, Probabilistic Robotics, 3.5 (information form).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.camera_step import PLANAR_ROWS, slip_sigmas
from tapreach.estimation.motion_prior import MountNoise, PoseErrors
from tapreach.estimation.odometry_noise import OdometryNoise, carried, pose_errors
from tapreach.estimation.step_knowledge import KNOWN, PLANAR, StepKnowledge
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import perturbed

SEEN_WRONG = np.array([0.0, 0.0, 0.0, 0.005, 0.005, 0.0])
"""One sigma of what the pictures of all steps have wrong in common, as an error of the mount that is not
there [rad]: their direction of travel is drawn to where the near and stretching floor is. Measured in
rendered rooms.
"""


@dataclass(frozen=True, eq=False)
class SeenStep:
    """What the background said of the step from pose number `first` to `second`."""

    first: int
    second: int
    knowledge: StepKnowledge


@dataclass(frozen=True, eq=False)
class CorrectedDrive:
    """world_from_base of each stop, base_from_camera, and the errors left in them.

    The first pose is exact. `errors` is what `estimate_point` takes as motion, with observations that have
    these poses and this mount.
    """

    poses: tuple[PlanarPose, ...]
    base_from_camera: RigidTransform
    errors: PoseErrors

    def step(self, first: int, second: int) -> tuple[PlanarPose, FloatArray]:
        """Return the step from pose number `first` to `second`, and the error (3, k) of its end, in the base
        there, per unit normal.
        """
        by_base = self.errors.by_base[:, PLANAR_ROWS]
        before = _carried(self.poses[first], self.poses[second]) @ by_base[first]
        return self.poses[first].between(self.poses[second]), np.asarray(by_base[second] - before)


def corrected_drive(
    poses: Sequence[PlanarPose],
    noise: OdometryNoise,
    base_from_camera: RigidTransform,
    mount_noise: MountNoise,
    steps: Sequence[SeenStep],
) -> CorrectedDrive:
    """Return the drive with what was seen of its steps taken in.

    A heading corrected moves what was driven since to the side as well; of a step whose wheels slipped only
    the pictures count. Raises InputError for a step between poses that are not there.
    """
    for step in steps:
        if not 0 <= step.first < step.second < len(poses):
            raise InputError(
                f"a step from pose {step.first} to {step.second}; there are {len(poses)} poses, in order"
            )
    by_base = _with_slips(pose_errors(poses, noise), poses, steps)
    by_mount = np.diag(np.repeat([mount_noise.position_sigma, mount_noise.angle_sigma], 3))
    mean, root = _posterior(by_base, by_mount, poses, steps)
    on_base = by_base.shape[2]
    on_mount = on_base + by_mount.shape[1]
    moved = by_base @ mean[:on_base]
    corrected = tuple(
        pose.compose(PlanarPose(*map(float, error))) for pose, error in zip(poses, moved, strict=True)
    )
    mount = perturbed(base_from_camera, by_mount @ mean[on_base:on_mount])
    return CorrectedDrive(corrected, mount, _errors_left(by_base, by_mount, root))


def _with_slips(by_base: FloatArray, poses: Sequence[PlanarPose], steps: Sequence[SeenStep]) -> FloatArray:
    """Return (n, 3, k'): `by_base` with three more normals for every step whose wheels slipped.

    Slip is taken as even over the poses in between.
    """
    columns = [by_base]
    for step in steps:
        if not step.knowledge.has_slipped:
            continue
        slip = np.zeros((len(poses), 3, 3))
        sigmas = slip_sigmas(poses[step.first].between(poses[step.second]))
        for i in range(step.first + 1, len(poses)):
            share = min(1.0, (i - step.first) / (step.second - step.first))
            onward = _carried(poses[min(i, step.second)], poses[i])
            slip[i] = onward @ np.diag(share * sigmas)
        columns.append(slip)
    return np.concatenate(columns, axis=2)


def _posterior(
    by_base: FloatArray, by_mount: FloatArray, poses: Sequence[PlanarPose], steps: Sequence[SeenStep]
) -> tuple[FloatArray, FloatArray]:
    """Return mean (k,) and a root (k, k) of the covariance of all normals: of the bases, of the mount, and of
    what is seen wrong.
    """
    of_mount = np.concatenate([by_mount, np.diag(SEEN_WRONG)[:, SEEN_WRONG > 0.0]], axis=1)
    on_base, size = by_base.shape[2], by_base.shape[2] + of_mount.shape[1]
    information, vector = np.eye(size), np.zeros(size)
    for step in steps:
        errors = np.zeros((KNOWN, size))
        before = _carried(poses[step.first], poses[step.second]) @ by_base[step.first]
        errors[:PLANAR, :on_base] = by_base[step.second] - before
        errors[PLANAR:, on_base:] = of_mount
        information += errors.T @ step.knowledge.information @ errors
        vector += errors.T @ step.knowledge.vector
    values, vectors = np.linalg.eigh(information)
    mean = vectors @ ((vectors.T @ vector) / values)
    return mean, np.asarray(vectors / np.sqrt(values))


def _carried(start: PlanarPose, end: PlanarPose) -> FloatArray:
    """Return (3, 3): what an error at `start` amounts to at `end`."""
    way = start.between(end)
    return np.asarray(carried(np.array([[way.x, way.y, way.heading]]))[0])


def _errors_left(by_base: FloatArray, by_mount: FloatArray, root: FloatArray) -> PoseErrors:
    on_base = by_base.shape[2]
    in_space = np.zeros((len(by_base), 6, len(root)))
    in_space[:, PLANAR_ROWS] = by_base @ root[:on_base]
    on_mount = on_base + by_mount.shape[1]
    return PoseErrors(in_space, by_mount @ root[on_base:on_mount])
