"""Where the base stands to grip a thing, and from where it looks at it for the last time before.

The arm is not in the middle of the base. A turn on the spot and a straight advance bring the thing to a
wanted place (gx, gy) in the base frame: from a thing at distance ρ and bearing β the base turns by
β − asin(gy / ρ) and advances by √(ρ² − gy²) − gx.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.reach import Grip, grip_for
from tapreach.tasks.fetch.sight import Sight, Upright
from tapreach.tasks.fetch.thing import ThingSize

ROTATIONS = tuple(math.radians(each) for each in (0.0, 12.0, -12.0, 25.0, -25.0))
"""Turns of servo A that are tried; straight ahead first: then no error of it moves the claw aside."""
LEAST_STRETCH = 0.06
"""The last look is at least so far before the stand [m]: there the arm is brought down clear of the thing."""
_LONGEST_STRETCH, _STRETCH_STEP = 1.2, 0.01
_REST = 0.005


@dataclass(frozen=True)
class Stance:
    """A way of standing before a thing: servo A at `rotation` [rad], so gripped.

    thing_in_base (2,): where the thing's middle then is [m]. stretch: how far before the stand the whole of
    it is last in the picture [m]; None where it never is whole in it.
    """

    rotation: float
    grip: Grip
    thing_in_base: FloatArray
    stretch: float | None

    def approach_from(self, base: PlanarPose, thing: FloatArray) -> PlanarStep | None:
        """Return the turn and the advance that bring the base from `base` to stand so before (2,).

        The advance may be negative. None where the thing is too near to be brought beside the middle.
        """
        off = thing - np.array([base.x, base.y])
        distance, aside = float(np.hypot(*off)), float(self.thing_in_base[1])
        if distance <= abs(aside) or distance < 1e-6:
            return None
        bearing = math.atan2(off[1], off[0]) - base.heading
        advance = math.sqrt(distance**2 - aside**2) - float(self.thing_in_base[0])
        return PlanarStep(wrapped(bearing - math.asin(aside / distance)), advance)

    def tips(self, claw: Claw) -> tuple[FloatArray, FloatArray]:
        """Return the gripping point (3,) before the arm goes out and when it grips, in the base frame [m]."""
        height, rotation = self.grip.height, self.rotation
        return claw.tip(self.grip.pre_grasp, height, rotation), claw.tip(self.grip.ahead, height, rotation)


def stances(size: ThingSize, claw: Claw, sight: Sight) -> Iterator[Stance]:
    """Yield the ways of standing that let the arm grip, straight ahead first; none where there is no grip."""
    for rotation in ROTATIONS:
        grip = grip_for(size, claw, rotation)
        if grip is not None:
            place = claw.tip(grip.ahead, grip.height, rotation)[:2]
            yield Stance(rotation, grip, place, _last_whole(size, place, sight))


def upright(size: ThingSize, middle: FloatArray) -> Upright:
    """Return the thing as a cylinder as wide as it looks, standing at (2,)."""
    return Upright(middle, size.width / 2.0, size.foot, size.foot + size.height)


def _last_whole(size: ThingSize, place_in_base: FloatArray, sight: Sight) -> float | None:
    """Return the least way back from the stand at which the whole thing is in the picture."""
    for back in np.arange(LEAST_STRETCH, _LONGEST_STRETCH, _STRETCH_STEP):
        ahead = place_in_base + np.array([back + _REST, 0.0])
        if sight.is_whole(upright(size, ahead), PlanarPose()):
            return float(back) + _REST
    return None
