"""A located point seen from where the base is now: what the wheels may have done wrong since makes it less
sure (docs/decisions/0005).
"""

import math
from dataclasses import dataclass

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.way_error import by_way


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
    added = by_way(found.sightings[-1].world_from_base, here, point, description)
    return PresentPoint(point, covariance + added, added)
