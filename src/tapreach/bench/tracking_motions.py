"""The motions that tapped places are followed through, as poses of the base from picture to picture."""

import math
from collections.abc import Iterator, Sequence
from enum import StrEnum

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose

TURN_STEP, ADVANCE_STEP = 0.05, 0.025
"""Of one picture [rad, m]: 0.5 rad/s and 0.25 m/s at 10 pictures a second."""


class Motion(StrEnum):
    """What the robot does while it watches."""

    LOCATE = "turn and advance"
    APPROACH = "approach from 2.5 to 0.4 m"
    RETURN = "turn away and back"
    CURVE = "curve past the things"


Leg = tuple[float, float]
"""Turn on the spot [rad], or advance [m]: one of the two is 0."""


def legs_of(motion: Motion, rng: np.random.Generator) -> list[Leg]:
    """Return the legs of a motion; of an approach the straight way, 2.1 m."""
    side = float(rng.choice([-1.0, 1.0]))
    if motion is Motion.LOCATE:
        turn = side * math.radians(float(rng.uniform(8.0, 20.0)))
        return [(turn, 0.0), (0.0, float(rng.uniform(0.2, 0.5)))]
    if motion is Motion.APPROACH:
        return [(0.0, 2.1)]
    if motion is Motion.RETURN:
        away = side * math.radians(float(rng.uniform(60.0, 75.0)))
        return [(away, 0.0), (0.0, float(rng.uniform(0.03, 0.12))), (-away, 0.0)]
    bend = side * math.radians(float(rng.uniform(15.0, 30.0)))
    return [(bend, 0.0), (0.0, float(rng.uniform(0.25, 0.45))), (-2.0 * bend, 0.0), (0.0, 0.25), (bend, 0.0)]


def steps_of(legs: Sequence[Leg]) -> Iterator[Leg]:
    """Cut legs into the steps between two pictures."""
    for turn, advance in legs:
        count = max(1, math.ceil(max(abs(turn) / TURN_STEP, abs(advance) / ADVANCE_STEP)))
        for _ in range(count):
            yield turn / count, advance / count


def poses_along(
    start: PlanarPose, steps: Sequence[Leg], turned: float = 1.0, driven: float = 1.0
) -> list[PlanarPose]:
    """Return the pose at the start and after each step; odometry counts `turned`, `driven` times as much."""
    poses = [start]
    for turn, advance in steps:
        poses.append(poses[-1].after_arc(advance * driven, turn * turned))
    return poses
