"""Where the thing truly is while it is fetched: lifted or not, between the fingers; and what else moved."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.drivers.sim.truth import ObjectTruth, WorldTruth

LIFTED = 0.02
"""A thing whose foot is so much higher than it stood is lifted [m]."""
MOVED = 0.02
"""What is not meant and is so far from where it stood was moved [m]."""
_FORGIVEN = 0.01
_ALONG_FINGERS = np.linspace(-0.025, 0.025, 11)
_ROUND = ("can", "bottle", "cup")


@dataclass(frozen=True)
class Standing:
    """How everything stood before: the foot of the thing that is meant ('' for none), and all middles."""

    thing: str
    before: WorldTruth

    def lift(self, now: WorldTruth) -> float:
        """Return how much higher the thing's foot is than it stood [m]; 0 for what is none."""
        if not self.thing:
            return 0.0
        return foot_height(now.object(self.thing)) - foot_height(self.before.object(self.thing))

    def is_held(self, now: WorldTruth) -> bool:
        """Tell whether the thing is lifted and between the fingers."""
        return bool(self.thing) and self.lift(now) >= LIFTED and is_between_fingers(now, self.thing)

    def moves(self, now: WorldTruth) -> dict[str, float]:
        """Return how far every thing is from where it stood [m], by its name."""
        return {
            each.name: math.dist(each.centre_in_world, now.object(each.name).centre_in_world)
            for each in self.before.objects
        }

    def others_moved(self, now: WorldTruth) -> tuple[str, ...]:
        """Return what was moved and not meant."""
        return tuple(name for name, way in self.moves(now).items() if name != self.thing and way > MOVED)


def is_between_fingers(now: WorldTruth, thing: str) -> bool:
    """Tell whether some place between the fingers, which reach 25 mm before and behind the gripping point,
    lies in the box that holds the thing; 1 cm is forgiven.
    """
    there = now.object(thing)
    along = np.column_stack([_ALONG_FINGERS, np.zeros((len(_ALONG_FINGERS), 2))])
    between = RigidTransform.from_matrix(np.array(now.world_from_gripper)).apply(along)
    in_thing = RigidTransform.from_matrix(np.array(there.world_from_object)).inv().apply(between)
    is_inside = np.all(np.abs(in_thing) <= 0.5 * np.array(there.size) + _FORGIVEN, axis=1)
    return bool(is_inside.any())


def foot_height(thing: ObjectTruth) -> float:
    """Return the height of the lowest point of a thing above the floor [m], however it lies."""
    up = np.array(thing.world_from_object)[2, :3]
    half = 0.5 * np.array(thing.size)
    if thing.kind == "ball":
        return thing.centre_in_world[2] - float(half[2])
    if thing.kind in _ROUND:
        reach = half[0] * math.hypot(up[0], up[1]) + half[2] * abs(up[2])
        return thing.centre_in_world[2] - float(reach)
    return thing.centre_in_world[2] - float(np.abs(up) @ half)
