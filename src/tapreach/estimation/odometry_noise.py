"""How wrong wheel odometry may be: a noise model, and what it does to a chain of poses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from tapreach.geometry.finite import FloatArray, not_negative
from tapreach.geometry.planar_motion import PlanarPose, wrapped


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
        way = _split(step)
        columns = _step_columns(way)
        turn = self.turn_per_sqrt_rad**2, self.turn_fraction**2
        distance = abs(way.advance)
        drift = self.turn_per_sqrt_m**2 * distance
        variances = [
            turn[0] * abs(way.first_turn) + turn[1] * way.first_turn**2,
            turn[0] * abs(way.last_turn) + turn[1] * way.last_turn**2,
            self.advance_per_sqrt_m**2 * distance + self.advance_fraction**2 * distance**2,
            drift,
            # A heading that drifts on the way also leaves this part of the sideways error unexplained.
            self.slip_per_sqrt_m**2 * distance + drift * distance**2 / 12.0,
        ]
        return np.asarray((columns * variances) @ columns.T)

    def scale_columns(self, step: PlanarPose) -> FloatArray:
        """Return (3, 2): the step's error for one sigma of the shared advance scale and turn scale."""
        way = _split(step)
        columns = _step_columns(way)
        by_turn = columns[:, 0] * way.first_turn + columns[:, 1] * way.last_turn
        return np.stack([columns[:, 2] * way.advance * self.advance_scale, by_turn * self.turn_scale], axis=1)


@dataclass(frozen=True)
class _Split:
    """A step as turn, advance, turn; the advance may be backwards."""

    first_turn: float
    advance: float
    last_turn: float


def _split(step: PlanarPose) -> _Split:
    distance = math.hypot(step.x, step.y)
    if distance < 1e-9:
        return _Split(step.heading, 0.0, 0.0)
    direction = math.atan2(step.y, step.x)
    forwards = _Split(direction, distance, wrapped(step.heading - direction))
    turned = wrapped(direction + math.pi)
    backwards = _Split(turned, -distance, wrapped(step.heading - turned))
    return min(forwards, backwards, key=lambda way: abs(way.first_turn) + abs(way.last_turn))


def _step_columns(way: _Split) -> FloatArray:
    """Return (3, 5): the end pose's change with first turn, last turn, advance, drift, sideways slip."""
    c, s = math.cos(way.last_turn), math.sin(way.last_turn)
    ahead, left = np.array([c, -s, 0.0]), np.array([s, c, 0.0])
    heading = np.array([0.0, 0.0, 1.0])
    return np.stack(
        [way.advance * left + heading, heading, ahead, way.advance / 2.0 * left + heading, left], axis=1
    )


def pose_errors(poses: Sequence[PlanarPose], noise: OdometryNoise) -> FloatArray:
    """Return (n, 3, k): each pose's error (x, y, heading; right perturbation) per independent unit normal.

    The poses are world_from_base along the way; the first is taken as exact. k is 2 for the shared scales
    and 3 for each step. The joint covariance of all poses is the product of this with its transpose.
    """
    count = len(poses)
    errors = np.zeros((count, 3, 2 + 3 * (count - 1)))
    for i in range(1, count):
        step = poses[i - 1].between(poses[i])
        errors[i] = _carried(step) @ errors[i - 1]
        errors[i, :, :2] += noise.scale_columns(step)
        errors[i, :, 3 * i - 1 : 3 * i + 2] += covariance_root(noise.step_covariance(step))
    return errors


def covariance_root(covariance: FloatArray) -> FloatArray:
    """Return a root R (n, n) with R Rᵀ = covariance; singular covariances are welcome."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.clip(values, 0.0, None)))


def _carried(step: PlanarPose) -> FloatArray:
    """Return (3, 3): what an error before the step amounts to in the frame after it (adjoint)."""
    c, s = math.cos(step.heading), math.sin(step.heading)
    # The heading error swings the end of the step about its start.
    return np.array([[c, s, s * step.x - c * step.y], [-s, c, c * step.x + s * step.y], [0.0, 0.0, 1.0]])
