"""What the wheels may have done wrong on a way, as it shows in a place that was known before it."""

import math

import numpy as np

from tapreach.estimation.odometry_noise import pose_errors
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.robot_noise import odometry_noise
from tapreach.tasks.sighting import is_apart

_AT_REST = 0.001, math.radians(0.1)
"""A way as short as that of a base which settles [m, rad]: its direction says nothing."""


def by_way(
    start: PlanarPose, here: PlanarPose, point: FloatArray, description: RobotDescription
) -> FloatArray:
    """Return the covariance (3, 3) [m²] that the way from `start` to `here` by the wheels adds to a `point`
    (3,) [m] of the world; none for a base that only settles.
    """
    if not is_apart(start, here, *_AT_REST):
        return np.zeros((3, 3))
    way_errors = pose_errors([start, here], odometry_noise(description))[1]
    moved_by = moved_by_base(point, here) @ way_errors
    return np.asarray(moved_by @ moved_by.T)


def moved_by_base(point: FloatArray, here: PlanarPose) -> FloatArray:
    """Return (3, 3): how a `point` (3,) [m] that stands still moves in the world in which a base at `here` is
    exact, per error (x, y, heading) of that base: the other way.
    """
    c, s = math.cos(here.heading), math.sin(here.heading)
    aside, ahead = point[1] - here.y, point[0] - here.x
    return np.array([[-c, s, aside], [-s, -c, -ahead], [0.0, 0.0, 0.0]])
