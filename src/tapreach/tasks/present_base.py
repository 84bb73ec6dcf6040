"""A located point seen from where the base is now: what the wheels may have done wrong since makes it less
sure (docs/decisions/0005).
"""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.estimation.odometry_noise import pose_errors
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.robot_noise import odometry_noise
from tapreach.tasks.sighting import is_apart

_AT_REST = 0.001, math.radians(0.1)
"""A way as short as that of a base which settles [m, rad]: its direction says nothing."""


@dataclass(frozen=True, eq=False)
class PresentPoint:
    """A target (3,) [m] with its covariance (3, 3) [m²], in the world that the present base is exact in.

    by_way: (3, 3) [m²], the part of the covariance that comes of the way since the last sighting.
    """

    point_in_world: FloatArray
    cov_in_world: FloatArray
    by_way: FloatArray

    def way_sd_along(self, direction: FloatArray) -> float:
        """Return one sigma [m] along a unit vector (3,) that comes of the way since."""
        return math.sqrt(max(0.0, float(direction @ self.by_way @ direction)))


def at_present(found: LocatedPoint, here: PlanarPose, description: RobotDescription) -> PresentPoint | None:
    """Return the target seen from the base that by the wheels is at `here`; None where there is none.

    The odometry's error of the way from the newest sighting to `here` is added.
    """
    point, covariance = found.point_in_world, found.point_cov_in_world
    if point is None or covariance is None:
        return None
    by_way = _by_way(found.sightings[-1].world_from_base, here, point, description)
    return PresentPoint(point, covariance + by_way, by_way)


def _by_way(
    start: PlanarPose, here: PlanarPose, point: FloatArray, description: RobotDescription
) -> FloatArray:
    if not is_apart(start, here, *_AT_REST):
        return np.zeros((3, 3))
    way_errors = pose_errors([start, here], odometry_noise(description))[1]
    # An error (x, y, heading) of the present base moves what stands still the other way.
    c, s = math.cos(here.heading), math.sin(here.heading)
    aside, ahead = point[1] - here.y, point[0] - here.x
    moved_by = np.array([[-c, s, aside], [-s, -c, -ahead], [0.0, 0.0, 0.0]]) @ way_errors
    return np.asarray(moved_by @ moved_by.T)
