"""How wrong wheel odometry may be: a noise model, and what it does to a chain of poses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np

from tapreach.geometry.finite import FloatArray, not_negative
from tapreach.geometry.planar_motion import PlanarPose

_Amount = TypeVar("_Amount", float, FloatArray)


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
    creep_per_rad: float = 0.0  # [m/rad], ahead and sideways while turning: no base turns about one point

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
        root = self.step_errors(np.array([[step.x, step.y, step.heading]]))[0, :, 2:]
        return np.asarray(root @ root.T)

    def step_errors(self, steps: FloatArray) -> FloatArray:
        """Return (n, 3, 5): the errors of steps (n, 3), each x, y [m], heading [rad], per unit normal.

        The first two columns are the shared scales of advances and turns. The others are each step's own:
        heading with the way sideways that comes of it, sideways without a turn, and along the advance. They
        are a root of `step_covariance` in closed form, so that what cannot err is exactly zero.
        """
        if len(steps) == 1:  # as between two taps: plain numbers are many times faster here
            return self._errors_of_step(*steps[0].tolist())[None]
        turns, advance = _split(steps)
        (first, last), (before, after) = turns, self._of_turns(np.abs(turns))
        heading, swing, sideways, along = self._spreads(before, after, first + last, advance)
        in_step = np.zeros((len(steps), 3, 5))  # of the frame that looks along the advance
        in_step[:, 2, 2], in_step[:, 1, 3], in_step[:, 0, 4] = np.sqrt((heading, sideways, along))
        in_step[:, 1, 2] = swing * in_step[:, 2, 2]
        if self.advance_scale > 0.0 or self.turn_scale > 0.0:
            in_step[:, 0, 0] = self.advance_scale * advance
            in_step[:, 1, 1] = self.turn_scale * first * advance
            in_step[:, 2, 1] = self.turn_scale * (first + last)
        return np.asarray(_turned(last) @ in_step)

    def _errors_of_step(self, x: float, y: float, turn: float) -> FloatArray:
        """Return `step_errors` (3, 5) of a single step."""
        first, last, advance = _split_step(x, y, turn)
        turned = self._of_turns(abs(first)), self._of_turns(abs(last))
        heading, swing, sideways, along = self._spreads(*turned, first + last, advance)
        heading, sideways, along = math.sqrt(heading), math.sqrt(sideways), math.sqrt(along)
        scaled, swung = self.advance_scale * advance, self.turn_scale * first * advance
        c, s = math.cos(last), math.sin(last)
        return np.array(
            [
                [c * scaled, s * swung, s * swing * heading, s * sideways, c * along],
                [-s * scaled, c * swung, c * swing * heading, c * sideways, -s * along],
                [0.0, self.turn_scale * (first + last), heading, 0.0, 0.0],
            ]
        )

    def _of_turns(self, amounts: _Amount) -> _Amount:
        """Return the variance of turns by these amounts."""
        return _variance(amounts, self.turn_per_sqrt_rad, self.turn_fraction)

    def _spreads(
        self, before: _Amount, after: _Amount, turn: _Amount, advance: _Amount
    ) -> tuple[_Amount, ...]:
        """Return variance of the heading, way sideways per error in it, other variance sideways and along.

        before, after: variance of the turns before and after the advance; turn: both together.
        """
        distance = abs(advance)
        drift = self.turn_per_sqrt_m**2 * distance
        turned = before + after
        heading = turned + drift
        shares = 1.0 / (heading + 1e-300)  # without any turning there is nothing to share
        # Turns before the advance swing its end by all of it, a drift on the way by half.
        swing = advance * (before + 0.5 * drift) * shares
        swing_left = (before * after + 0.25 * turned * drift) * shares
        # A heading that drifts on the way also leaves a twelfth of its square in the sideways error.
        sideways = advance * advance * (swing_left + drift / 12.0) + self.slip_per_sqrt_m**2 * distance
        along = _variance(distance, self.advance_per_sqrt_m, self.advance_fraction)
        crept = (self.creep_per_rad * turn) ** 2
        return heading, swing, sideways + crept, along + crept


def _variance(amount: _Amount, per_sqrt: float, fraction: float) -> _Amount:
    return amount * (per_sqrt**2 + fraction**2 * amount)


def _turned(turns: FloatArray) -> FloatArray:
    """Return (n, 3, 3): to the frame after turns (n,) from that before them."""
    rotations = np.zeros((len(turns), 3, 3))
    rotations[:, 0, 0] = rotations[:, 1, 1] = np.cos(turns)
    rotations[:, 0, 1] = np.sin(turns)
    rotations[:, 1, 0] = -rotations[:, 0, 1]
    rotations[:, 2, 2] = 1.0
    return rotations


def _split_step(x: float, y: float, turn: float) -> tuple[float, float, float]:
    """Return a step as first turn, last turn and advance; it goes backwards where that turns less in all."""
    ahead = math.atan2(y, x)
    back = ahead - math.copysign(math.pi, ahead)
    after_ahead, after_back = math.remainder(turn - ahead, math.tau), math.remainder(turn - back, math.tau)
    if abs(back) + abs(after_back) < abs(ahead) + abs(after_ahead):
        return back, after_back, -math.hypot(x, y)
    return ahead, after_ahead, math.hypot(x, y)


def _split(steps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return steps (n, 3) as turns before and after (2, n) and advance (n,); it may be backwards."""
    x, y, heading = steps.T
    turns, advance = np.empty((2, len(steps))), np.hypot(x, y)
    np.arctan2(y, x, out=turns[0])
    turns[1] = _wrapped(heading - turns[0])
    is_backwards = np.abs(turns).sum(axis=0) > math.pi  # then that turns less in all
    if is_backwards.any():
        turns[0] -= is_backwards * np.copysign(math.pi, turns[0])
        turns[1] = _wrapped(heading - turns[0])
        advance[is_backwards] *= -1.0
    on_the_spot = np.abs(advance) < 1e-9
    if on_the_spot.any():
        turns[0, on_the_spot], turns[1, on_the_spot] = _wrapped(heading[on_the_spot]), 0.0
        advance[on_the_spot] = 0.0
    return turns, advance


def _wrapped(angles: FloatArray) -> FloatArray:
    return np.asarray(angles - 2.0 * math.pi * np.rint(angles / (2.0 * math.pi)))


def pose_errors(poses: Sequence[PlanarPose], noise: OdometryNoise) -> FloatArray:
    """Return `chain_errors` (n, 3, k) of poses world_from_base along the way."""
    given = np.array([(pose.x, pose.y, pose.heading) for pose in poses])
    return chain_errors(_ways(given[0], given), noise)


def chain_errors(poses: FloatArray, noise: OdometryNoise) -> FloatArray:
    """Return (n, 3, k): each pose's error (x, y, heading; right perturbation) per independent unit normal.

    poses (n, 3), x, y, heading: along the way, as seen from the first, which is taken as exact. k is 2 for
    the shared scales and for each step one for all that may err in it, at most 3. The joint covariance of
    all poses is the product of this with its transpose.
    """
    steps = _ways(poses[:-1], poses[1:])
    count, own = len(steps), noise.step_errors(steps)
    if count == 1:  # nothing is carried on
        return np.concatenate([np.zeros_like(own), own])
    onward = carried(poses[1:])
    in_start = _inverses(onward) @ own
    shared, of_steps = in_start[..., :2].cumsum(axis=0), in_start[..., 2:].swapaxes(0, 1)
    may_err = np.flatnonzero(own[..., 2:].any(axis=1))
    each = of_steps.reshape(3, 3 * count).take(may_err, axis=1)
    is_before = may_err // 3 <= np.arange(count)[:, None]  # a step moves no pose before it
    errors = np.zeros((count + 1, 3, 2 + len(may_err)))
    np.matmul(onward, np.concatenate([shared, is_before[:, None] * each], axis=2), out=errors[1:])
    return errors


def _inverses(adjoints: FloatArray) -> FloatArray:
    """Return the inverses (n, 3, 3) of what `carried` returns."""
    inverses = np.zeros_like(adjoints)
    inverses[:, :2, :2] = adjoints[:, :2, :2].mT
    inverses[:, :2, 2:] = -(inverses[:, :2, :2] @ adjoints[:, :2, 2:])
    inverses[:, 2, 2] = 1.0
    return inverses


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
        steps = _ways(before[0], coming[:, i])
        own = noise.step_errors(steps)
        on_ways[:, i] = carried(steps) @ before[1]
        on_ways[:, i, :, :2] += own[..., :2]
        on_ways[:, i, :, k + 3 * i : k + 3 * i + 3] = own[..., 2:]
        before = coming[:, i], on_ways[:, i]
    return errors


def covariance_root(covariance: FloatArray) -> FloatArray:
    """Return a root R (..., n, n) with R Rᵀ = covariance; singular covariances are welcome."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :])


def _ways(from_poses: FloatArray, to_poses: FloatArray) -> FloatArray:
    """Return (n, 3): the poses `to_poses` as seen from `from_poses`; one of them may stand for many."""
    c, s = np.cos(from_poses[..., 2]), np.sin(from_poses[..., 2])
    ways = np.asarray(to_poses - from_poses)
    x, y = ways[..., 0].copy(), ways[..., 1].copy()
    ways[..., 0], ways[..., 1] = c * x + s * y, c * y - s * x
    return ways


def carried(ways: FloatArray) -> FloatArray:
    """Return (n, 3, 3): what an error before a way (n, 3) amounts to in the frame after it (adjoint)."""
    x, y, heading = ways.T
    c, s = np.cos(heading), np.sin(heading)
    adjoints = np.zeros((len(ways), 3, 3))
    adjoints[:, 0, 0], adjoints[:, 0, 1], adjoints[:, 1, 0], adjoints[:, 1, 1] = c, s, -s, c
    # The heading error swings the end of the way about its start.
    adjoints[:, 0, 2], adjoints[:, 1, 2], adjoints[:, 2, 2] = s * x - c * y, c * x + s * y, 1.0
    return adjoints
