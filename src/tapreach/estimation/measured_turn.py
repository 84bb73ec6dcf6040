"""Poses by odometry, corrected by turns that were measured otherwise (as by the background).

The errors of all poses are one linear map of unit normals (odometry_noise.chain_errors); each measured turn
is a linear measurement of them, taken in by the Kalman update. Source: Thrun, Burgard and Fox, Probabilistic
Robotics, 3.2.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.geometry.finite import FloatArray, finite, not_negative
from tapreach.geometry.planar_motion import PlanarPose

_PLANAR_ROWS = [0, 1, 5]


@dataclass(frozen=True)
class MeasuredTurn:
    """From pose number `first` to `second` the base turned by `excess` [rad, left] more than the wheels said.

    sd: one sigma [rad], infinite for a turn that was not seen. InputError for numbers that are not such.
    """

    first: int
    second: int
    excess: float
    sd: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "excess", finite("excess", self.excess))
        if self.sd != float("inf"):
            object.__setattr__(self, "sd", not_negative("sd", self.sd))


@dataclass(frozen=True, eq=False)
class CorrectedPoses:
    """world_from_base of each stop, and their joint covariance (6n, 6n), tangent order (translation,
    rotation), right perturbation; the first pose is exact. As `estimate_point` takes them.
    """

    poses: tuple[PlanarPose, ...]
    covariance: FloatArray


def with_measured_turns(
    poses: Sequence[PlanarPose], noise: OdometryNoise, turns: Sequence[MeasuredTurn]
) -> CorrectedPoses:
    """Return the poses along a drive with everything known of their turns.

    A heading corrected moves what was driven since to the side as well. Raises InputError for a turn between
    poses that are not there.
    """
    by_normal = pose_errors(poses, noise)
    mean, covariance = np.zeros(by_normal.shape[2]), np.eye(by_normal.shape[2])
    for turn in turns:
        if not 0 <= turn.first < len(poses) or not 0 <= turn.second < len(poses):
            raise InputError(f"a turn from pose {turn.first} to {turn.second}; there are {len(poses)} poses")
        measured = by_normal[turn.second, 2] - by_normal[turn.first, 2]
        gain = covariance @ measured / max(float(measured @ covariance @ measured) + turn.sd**2, 1e-18)
        mean = mean + gain * (turn.excess - float(measured @ mean))
        covariance = covariance - np.outer(gain, measured @ covariance)
    errors = by_normal @ mean
    corrected = tuple(
        pose.compose(PlanarPose(*map(float, error))) for pose, error in zip(poses, errors, strict=True)
    )
    return CorrectedPoses(corrected, _in_space(by_normal, covariance))


def _in_space(by_normal: FloatArray, covariance: FloatArray) -> FloatArray:
    """Return the joint covariance (6n, 6n) of poses that keep to the floor."""
    count = len(by_normal)
    errors = np.zeros((count, 6, by_normal.shape[2]))
    errors[:, _PLANAR_ROWS] = by_normal
    flat = errors.reshape(6 * count, -1)
    joint = flat @ covariance @ flat.T
    return np.asarray((joint + joint.T) / 2.0)
