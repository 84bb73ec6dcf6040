"""How wrong wheel odometry may be: a noise model, and what it does to a chain of poses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from tapreach.geometry.finite import FloatArray, not_negative
from tapreach.geometry.planar_motion import PlanarPose


@dataclass(frozen=True)
class OdometryNoise:
    """Standard deviations of wheel odometry. Zero or more each, else InputError.

    The first four grow with the root of the way: cutting a step in two changes nothing. The fractions make
    an independent error in every step; the scales make one error shared by all steps, as a wrong wheel
    radius or track width does. The defaults suit a small calibrated rover on a hard floor.
    """

    advance_per_sqrt_m: float = 0.01  # [√m]
    turn_per_sqrt_rad: float = 0.01  # [√rad], while turning
    turn_per_sqrt_m: float = 0.01  # [rad/√m], drift of the heading while advancing
    slip_per_sqrt_m: float = 0.005  # [√m], sideways
    advance_fraction: float = 0.0  # of each advance
    turn_fraction: float = 0.0  # of each turn
    advance_scale: float = 0.01  # of all advances together
    turn_scale: float = 0.01  # of all turns together

    def __post_init__(self) -> None:
        for each in fields(self):
            object.__setattr__(self, each.name, not_negative(each.name, getattr(self, each.name)))

    @classmethod
    def per_step(cls, fraction: float) -> "OdometryNoise":
        """Return independent errors of `fraction` of each turn and each advance, and no other error."""
        return cls(0.0, 0.0, 0.0, 0.0, fraction, fraction, 0.0, 0.0)

    def step_covariance(self, step: PlanarPose) -> FloatArray:
        """Return the covariance (3, 3) of a step before_from_after, without the shared scales.

        Order x, y [m], heading [rad], perturbing on the right (in the frame after the step).
        """
        return np.asarray(self.step_covariances(np.array([[step.x, step.y, step.heading]]))[0])

    def step_covariances(self, steps: FloatArray) -> FloatArray:
        """Return `step_covariance` (n, 3, 3) of many steps (n, 3), each x, y [m], heading [rad]."""
        first_turn, advance, last_turn = _split(steps)
        columns = _step_columns(advance, last_turn)
        turns, distance = np.abs(np.stack([first_turn, last_turn])), np.abs(advance)
        by_turns = self.turn_per_sqrt_rad**2 * turns + self.turn_fraction**2 * turns**2
        by_advance = self.advance_per_sqrt_m**2 * distance + self.advance_fraction**2 * distance**2
        drift = self.turn_per_sqrt_m**2 * distance
        # A heading that drifts on the way also leaves this part of the sideways error unexplained.
        slip = self.slip_per_sqrt_m**2 * distance + drift * distance**2 / 12.0
        variances = np.stack([*by_turns, by_advance, drift, slip], axis=1)
        return np.asarray((columns * variances[:, None]) @ np.swapaxes(columns, 1, 2))

    def scale_columns(self, steps: FloatArray) -> FloatArray:
        """Return (n, 3, 2): the errors of steps (n, 3) for one sigma of the two shared scales."""
        first_turn, advance, last_turn = _split(steps)
        columns = _step_columns(advance, last_turn)
        by_turn = columns[..., 0] * first_turn[:, None] + columns[..., 1] * last_turn[:, None]
        by_advance = columns[..., 2] * advance[:, None]
        return np.stack([by_advance * self.advance_scale, by_turn * self.turn_scale], axis=2)


def _split(steps: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return steps (n, 3) as turn, advance, turn, (n,) each; the advance may be backwards."""
    distance, heading = np.hypot(steps[:, 0], steps[:, 1]), _wrapped(steps[:, 2])
    direction = np.arctan2(steps[:, 1], steps[:, 0])
    forwards = direction, distance, _wrapped(heading - direction)
    turned = _wrapped(direction + math.pi)
    backwards = turned, -distance, _wrapped(heading - turned)
    is_forwards = np.abs(forwards[0]) + np.abs(forwards[2]) <= np.abs(turned) + np.abs(backwards[2])
    on_the_spot = distance < 1e-9
    split = (np.where(is_forwards, ahead, back) for ahead, back in zip(forwards, backwards, strict=True))
    first_turn, advance, last_turn = (np.where(on_the_spot, 0.0, part) for part in split)
    return np.where(on_the_spot, heading, first_turn), advance, last_turn


def _wrapped(angles: FloatArray) -> FloatArray:
    return np.asarray(angles - 2.0 * math.pi * np.rint(angles / (2.0 * math.pi)))


def _step_columns(advance: FloatArray, last_turn: FloatArray) -> FloatArray:
    """Return (n, 3, 5): the end poses' change with first turn, last turn, advance, drift, sideways slip."""
    c, s = np.cos(last_turn), np.sin(last_turn)
    columns = np.zeros((len(advance), 3, 5))
    columns[:, 0, 2], columns[:, 1, 2] = c, -s
    columns[:, 0, 4], columns[:, 1, 4] = s, c
    columns[:, :2, 0] = advance[:, None] * columns[:, :2, 4]
    columns[:, :2, 3] = 0.5 * columns[:, :2, 0]
    columns[:, 2, [0, 1, 3]] = 1.0
    return columns


def pose_errors(poses: Sequence[PlanarPose], noise: OdometryNoise) -> FloatArray:
    """Return `chain_errors` (n, 3, k) of poses world_from_base along the way."""
    return chain_errors(np.array([(pose.x, pose.y, pose.heading) for pose in poses]), noise)


def chain_errors(poses: FloatArray, noise: OdometryNoise) -> FloatArray:
    """Return (n, 3, k): each pose's error (x, y, heading; right perturbation) per independent unit normal.

    poses (n, 3), x, y, heading: world_from_base along the way; the first is taken as exact. k is 2 for the
    shared scales and 3 for each step. The joint covariance of all poses is the product of this with its
    transpose.
    """
    steps = _ways(poses[:-1], poses[1:])
    count = len(steps)
    onward = carried(_ways(poses[0], poses[1:]))
    backward = np.linalg.inv(onward)
    errors = np.zeros((count + 1, 3, 2 + 3 * count))
    errors[1:, :, :2] = onward @ np.cumsum(backward @ noise.scale_columns(steps), axis=0)
    in_start = backward @ covariance_root(noise.step_covariances(steps))
    by_step = onward[:, None] @ in_start
    by_step[np.triu_indices(count, 1)] = 0.0  # a step moves no pose before it
    errors[1:, :, 2:] = np.swapaxes(by_step, 1, 2).reshape(count, 3, 3 * count)
    return errors


def with_next_errors(
    known: FloatArray, last: FloatArray, coming: FloatArray, noise: OdometryNoise
) -> FloatArray:
    """Return `chain_errors` (n, 3, k) with c ways more of v poses each, all from the last (3,) of them on.

    known: (n, 3, k) of the chain. coming: (c, v, 3). The ways share 3 v more normals: (n + c v, 3, k + 3 v).
    """
    count, length = coming.shape[:2]
    n, _, k = known.shape
    errors = np.zeros((n + count * length, 3, k + 3 * length))
    errors[:n, :, :k] = known
    on_ways = errors[n:].reshape(count, length, 3, -1)
    before = np.broadcast_to(last, (count, 3)), np.broadcast_to(errors[n - 1], (count, *errors.shape[1:]))
    for i in range(length):
        steps, own = _ways(before[0], coming[:, i]), slice(k + 3 * i, k + 3 * i + 3)
        on_ways[:, i] = carried(steps) @ before[1]
        on_ways[:, i, :, :2] += noise.scale_columns(steps)
        on_ways[:, i, :, own] = covariance_root(noise.step_covariances(steps))
        before = coming[:, i], on_ways[:, i]
    return errors


def covariance_root(covariance: FloatArray) -> FloatArray:
    """Return a root R (..., n, n) with R Rᵀ = covariance; singular covariances are welcome."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :])


def _ways(from_poses: FloatArray, to_poses: FloatArray) -> FloatArray:
    """Return (n, 3): the poses `to_poses` as seen from `from_poses`; one of them may stand for many."""
    c, s = np.cos(from_poses[..., 2]), np.sin(from_poses[..., 2])
    apart = to_poses - from_poses
    x, y = c * apart[..., 0] + s * apart[..., 1], c * apart[..., 1] - s * apart[..., 0]
    return np.stack([x, y, apart[..., 2]], axis=-1)


def carried(ways: FloatArray) -> FloatArray:
    """Return (n, 3, 3): what an error before a way (n, 3) amounts to in the frame after it (adjoint)."""
    x, y, heading = ways.T
    c, s = np.cos(heading), np.sin(heading)
    adjoints = np.zeros((len(ways), 3, 3))
    adjoints[:, 0, 0], adjoints[:, 0, 1], adjoints[:, 1, 0], adjoints[:, 1, 1] = c, s, -s, c
    # The heading error swings the end of the way about its start.
    adjoints[:, 0, 2], adjoints[:, 1, 2], adjoints[:, 2, 2] = s * x - c * y, c * x + s * y, 1.0
    return adjoints
