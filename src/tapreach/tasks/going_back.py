"""Going back from where a target went out of sight: behind something that its own move brought before it."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.geometry.ray import Ray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.optics import optics_of

LEAST_ASIDE = 0.03
"""A camera this near to the first line of sight [m] has gone to neither side of it."""


@dataclass(frozen=True)
class LostSide:
    """A side of the first line of sight `ray` to which the target is hidden from view.

    seen_to [m]: how far to the left of the line the camera has seen it, negative to the right.
    """

    ray: Ray
    is_left: bool
    seen_to: float

    @classmethod
    def between(
        cls, ray: Ray, seen_from: PlanarPose, lost_at: PlanarPose, description: RobotDescription
    ) -> "LostSide | None":
        """Return the side to which a base (world_from_base) went that lost it; None where it was neither."""
        mount = optics_of(description.camera)[1]
        cameras = np.array([(pose.to_rigid() * mount).translation for pose in (seen_from, lost_at)])
        seen_to, lost_to = map(float, to_the_left(ray, cameras))
        if abs(lost_to) < LEAST_ASIDE:
            return None
        is_left = lost_to > 0.0
        return cls(ray, is_left, max(seen_to, 0.0) if is_left else min(seen_to, 0.0))

    def hides_from(self, cameras: FloatArray) -> npt.NDArray[np.bool_]:
        """Tell of cameras (..., 3) in the world which would go farther to that side than it was seen."""
        beyond = to_the_left(self.ray, cameras) - self.seen_to
        return np.asarray(beyond > 0.0 if self.is_left else beyond < 0.0)


def to_the_left(ray: Ray, points: FloatArray) -> FloatArray:
    """Return how far (...,) [m] points (..., 3) lie to the left of a line of sight, as seen from above."""
    x, y = ray.direction[:2] / max(float(np.hypot(*ray.direction[:2])), 1e-9)
    return np.asarray((points[..., :2] - ray.origin[:2]) @ np.array([-y, x]))


def way_back(start: PlanarPose, here: PlanarPose) -> tuple[PlanarStep, PlanarStep]:
    """Return the advance and then the turn that undo a turn and an advance from `start`."""
    came = here.between(start)
    return PlanarStep(0.0, came.x), PlanarStep(wrapped(start.heading - here.heading), 0.0)
