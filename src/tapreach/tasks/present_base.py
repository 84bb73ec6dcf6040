"""A located point seen from where the base is now: corrected by what the background showed of the way since
the last sighting, and less sure by what wheels and pictures may have wrong of it (docs/decisions/0005).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.corrected_drive import corrected_drive
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import Passed, Sighting
from tapreach.tasks.straightening import seen_steps
from tapreach.tasks.way_error import by_way, moved_by_base

_MOST_PASSED = 80
"""After more pictures without a sight of the target what they say of the way is not worth its time, which
grows with the cube of their number.
"""


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


def at_present(
    found: LocatedPoint,
    here: PlanarPose,
    description: RobotDescription,
    way: Sequence[Sighting | Passed] = (),
) -> PresentPoint | None:
    """Return the target seen from the base that by the wheels is at `here`; None where there is none.

    way: what the way since the newest sighting of `found` was seen by (see Follower.way_since). The error
    that is left of it is added; without what was seen, and after very many pictures, that of the wheels.
    """
    point, covariance = found.point_in_world, found.point_cov_in_world
    if point is None or covariance is None:
        return None
    last = found.sightings[-1]
    if not 0 < sum(isinstance(each, Passed) for each in way) <= _MOST_PASSED:
        added = by_way(last.world_from_base, here, point, description)
        return PresentPoint(point, covariance + added, added)
    corrected, errors = _bridged(way, last.frame_id, here, description)
    moved = here.to_rigid() * last.world_from_base.compose(corrected).to_rigid().inv()
    return _moved(point, covariance, moved, moved_by_base(moved.apply(point), here) @ errors)


def _moved(
    point: FloatArray, covariance: FloatArray, moved: RigidTransform, errors: FloatArray
) -> PresentPoint:
    rotation = moved.rotation.as_matrix()
    added = errors @ errors.T
    there = rotation @ covariance @ rotation.T + added
    return PresentPoint(np.asarray(moved.apply(point)), np.asarray(there), np.asarray(added))


def _bridged(
    way: Sequence[Sighting | Passed], since_id: int, here: PlanarPose, description: RobotDescription
) -> tuple[PlanarPose, FloatArray]:
    """Return the step of the base from frame `since_id` to `here` as wheels and background tell it, and its
    errors (3, k) per unit normal at its end.
    """
    poses = [*(each.world_from_base for each in way), here]
    first = next(i for i, each in enumerate(way) if each.frame_id == since_id)
    mount = description.camera.mount.base_from_camera()
    drive = corrected_drive(
        poses, odometry_noise(description), mount, mount_noise(description), seen_steps(way)
    )
    return drive.step(first, len(way))
