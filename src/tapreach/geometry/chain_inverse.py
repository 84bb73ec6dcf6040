"""The inverse of any arm chain: damped least squares within the joints' ranges, from several starts.

Source: Levenberg and Marquardt; Nakamura and Hanafusa (1986), inverse kinematics with singularity robustness.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from tapreach.geometry.arm_chain import ArmChain
from tapreach.geometry.finite import FloatArray, finite_array

NEAR_ENOUGH = 1e-6
"""Distance from the goal [m] that counts as there."""
STARTS = 12
_STEPS = 60
_DAMPING = 1e-3
_STUCK = 1e6
_LITTLE = 1e-6
"""Share of the squared distance: a step that gains less has arrived where nothing more is to be gained."""


@dataclass(frozen=True)
class ChainSolution:
    """Angles (n,) [rad] of the best that was found, and how far its tip is from the goal [m]."""

    angles: FloatArray
    distance: float

    @property
    def is_there(self) -> bool:
        """True when the tip is at the goal."""
        return self.distance <= NEAR_ENOUGH


def solve_chain(
    chain: ArmChain, tip_in_base: npt.ArrayLike, near: npt.ArrayLike | None = None, is_free: bool = False
) -> ChainSolution:
    """Return angles that bring the tip to (3,) in the base frame [m], or as near as was found.

    Starts at `near` (n,) [rad] where given, then from places spread evenly over the ranges, always the same
    ones; the first that gets there is the answer, so along a path hand in the solution before. is_free: leave
    the ranges aside (each joint may turn half a turn either way). Raises InputError for what is not finite.
    """
    goal = finite_array("tip_in_base", tip_in_base, (3,))
    ranges = np.tile((-np.pi, np.pi), (len(chain.joints), 1)) if is_free else chain.ranges
    best: ChainSolution | None = None
    for start in _starts(ranges, near):
        found = _descend(chain, goal, start, ranges)
        if best is None or found.distance < best.distance:
            best = found
        if best.is_there:
            break
    assert best is not None
    return best


def _starts(ranges: FloatArray, near: npt.ArrayLike | None) -> list[FloatArray]:
    low, high = ranges.T
    spread = qmc.Halton(d=len(ranges), scramble=False).random(STARTS)
    starts = [(low + high) / 2.0, *(low + spread * (high - low))]
    if near is not None:
        starts.insert(0, np.clip(finite_array("near", near, (len(ranges),)), low, high))
    return starts


def _descend(chain: ArmChain, goal: FloatArray, start: FloatArray, ranges: FloatArray) -> ChainSolution:
    angles, damping = start, _DAMPING
    skeleton, jacobian = chain.placed(angles)
    error, gained = goal - skeleton[-1], math.inf
    for _ in range(_STEPS):
        if np.linalg.norm(error) <= 0.1 * NEAR_ENOUGH or damping > _STUCK or gained < _LITTLE:
            break
        candidate = np.clip(angles + _step(jacobian, angles, error, damping, ranges), *ranges.T)
        skeleton, candidate_jacobian = chain.placed(candidate)
        rest = goal - skeleton[-1]
        if rest @ rest < error @ error:
            gained = 1.0 - float(rest @ rest) / float(error @ error)
            angles, error, jacobian, damping = candidate, rest, candidate_jacobian, damping / 5.0
        else:
            damping *= 10.0
    return ChainSolution(angles, float(np.linalg.norm(error)))


def _step(
    jacobian: FloatArray, angles: FloatArray, error: FloatArray, damping: float, ranges: FloatArray
) -> FloatArray:
    """Return the damped step; a joint at its stop that would be pushed beyond it stays out of it."""
    pull = jacobian.T @ error
    is_held = ((angles <= ranges[:, 0]) & (pull < 0.0)) | ((angles >= ranges[:, 1]) & (pull > 0.0))
    moving = jacobian[:, ~is_held]
    # Damping grows with the arm's own size, so that it means the same for a small and a large arm.
    size = float(np.max(np.sum(jacobian**2, axis=0))) or 1.0
    step = np.zeros_like(angles)
    normal = moving.T @ moving + damping * size * np.eye(moving.shape[1])
    step[~is_held] = np.linalg.solve(normal, pull[~is_held])
    return step
