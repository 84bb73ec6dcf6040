"""The robot's base seen from above, and the floor it passes over when it turns and drives."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from tapreach.geometry.convex import convex_hull
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import BaseSection, RobotDescription
from tapreach.tasks.fetch.obstacle import Surroundings, out_of

_FRONT, _REAR = 0.10, 0.15
"""What a robot whose file tells nothing of its body is taken to reach ahead and back [m]."""
_BESIDE_WHEEL = 0.015
"""What wheels reach beyond the lines on which they roll [m]."""
_HULL_STEP = math.radians(10.0)


@dataclass(frozen=True)
class Outline:
    """Corners (k, 2) in the base frame [m], convex, counter-clockwise."""

    corners: FloatArray

    @classmethod
    def around(cls, points_in_base: npt.ArrayLike) -> "Outline":
        """Return the hull of points (n, 2) in the base frame [m]. Raises InputError as `convex_hull`."""
        return cls(convex_hull(points_in_base))

    @classmethod
    def of(cls, description: RobotDescription) -> "Outline":
        """Return the robot's outline by its file: as given there, or around wheels and body."""
        base = description.base
        if base.outline:
            return cls.around((*base.outline, *_wheels(base)))
        corners = [(x, y) for part in description.body for x in part.x for y in part.y]
        half = base.track_width / 2.0 + _BESIDE_WHEEL
        box = [(x, y) for x in (-_REAR, _FRONT) for y in (-half, half)]
        return cls.around((*(corners or box), *_wheels(base)))

    @property
    def turning_radius(self) -> float:
        """Radius of the floor it takes when it turns about on the spot [m]."""
        return float(np.hypot(*self.corners.T).max())

    @property
    def half_width(self) -> float:
        """How far it reaches to the wider side [m]."""
        return float(np.abs(self.corners[:, 1]).max())

    @property
    def front(self) -> float:
        """How far it reaches ahead of the wheel axis [m]."""
        return float(self.corners[:, 0].max())

    @property
    def rear(self) -> float:
        """How far it reaches behind the wheel axis [m], positive."""
        return float(-self.corners[:, 0].min())

    def at(self, world_from_base: PlanarPose) -> FloatArray:
        """Return the corners (k, 2) of the base standing there."""
        return out_of(world_from_base, self.corners)

    def swept_by_advance(self, world_from_base: PlanarPose, distance: float) -> FloatArray:
        """Return the convex polygon (k, 2) passed over when driving straight: exact."""
        end = world_from_base.after(PlanarStep(0.0, distance))
        return convex_hull(np.concatenate([self.at(world_from_base), self.at(end)]))

    def turn_clearances(
        self, world_from_base: PlanarPose, turn: float, surroundings: Surroundings
    ) -> FloatArray:
        """Return (m,): the least way to each obstacle while turning on the spot [m], never too large.

        Between two headings a corner leaves the hull of both by no more than the arc's height.
        """
        count = 1 + math.ceil(abs(turn) / _HULL_STEP)
        headings = np.linspace(0.0, turn, count + 1)
        poses = [world_from_base.after(PlanarStep(float(each), 0.0)) for each in headings]
        corners = [self.at(pose) for pose in poses]
        hulls = [convex_hull(np.concatenate(pair)) for pair in pairwise(corners)]
        arc_height = self.turning_radius * (1.0 - math.cos(turn / count / 2.0))
        return np.asarray(np.min([surroundings.clearances(hull) for hull in hulls], axis=0) - arc_height)


def _wheels(base: BaseSection) -> list[tuple[float, float]]:
    half, radius = base.track_width / 2.0 + _BESIDE_WHEEL, base.wheel_radius
    return [(x, y) for x in (-radius, radius) for y in (-half, half)]
