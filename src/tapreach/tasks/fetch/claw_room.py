"""Where the level claw can be: how far ahead of the arm's turret, at one height and one turn of servo A."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.arm_workspace import MARGIN, ArmWorkspace, Unreachable

STEP = 0.016
"""Places are tried this far apart [m]; a smaller gap in the room or a smaller room is of no use."""
EXACT = 0.0005
"""The ends of a room are right to this [m], and never too far out."""
CLEAR = 0.008
"""Way kept between the claw and the floor [m]."""
SPARE = 0.002
"""Kept from floor and base beyond what paths of the arm keep [m]."""
LIFT = 0.06
"""What is gripped must be able to go up by this [m]."""


@dataclass(frozen=True)
class Room:
    """Ways of the gripping point from the turret's axis, level [m]: all between the two can be reached."""

    nearest: float
    farthest: float


@dataclass(frozen=True)
class Claw:
    """The arm of a robot as a grasp sees it."""

    arm: ArmWorkspace

    @classmethod
    def of(cls, description: RobotDescription) -> "Claw":
        """Return the claw that the robot's file describes."""
        return cls(ArmWorkspace.of(description))

    @cached_property
    def turret(self) -> FloatArray:
        """Where the axis of servo A stands in the base frame, (2,) [m]."""
        return np.asarray(self.arm.kinematics.skeleton(ArmJoints(0.0, 0.0, 0.0))[0, :2])

    @property
    def opens_to(self) -> float:
        """Its widest opening [m]."""
        return self.arm.claw_max

    @property
    def beyond(self) -> float:
        """How far the fingers reach beyond the gripping point [m]."""
        return self.arm.shape.finger_beyond

    @property
    def lowest(self) -> float:
        """Least height of the gripping point at which nothing near the claw brushes the floor [m]."""
        return max(self.arm.shape.hand_radius, self.arm.shape.link_radius) + CLEAR

    @cached_property
    def longest(self) -> float:
        """All links in a line [m]."""
        points = self.arm.kinematics.skeleton(ArmJoints(0.0, 0.0, 0.0))
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    def outer_width(self, opening: float) -> float:
        """Return how wide the claw itself is when it is open by `opening` [m]."""
        shape = self.arm.shape
        return max(opening + 2.0 * shape.finger_thickness, shape.palm_width)

    def tip(self, ahead: float, height: float, rotation: float) -> FloatArray:
        """Return the gripping point (3,) in the base frame [m]."""
        x, y = self.turret + ahead * np.array([math.cos(rotation), math.sin(rotation)])
        return np.array([x, y, height])

    def room(self, height: float, opening: float, rotation: float = 0.0) -> Room | None:
        """Return the widest unbroken room at `height` [m] from which it can also be lifted; None for none."""
        # The same few heights and openings are asked for again and again while a way is looked for.
        return _room(self, round(height, 3), round(opening, 3), rotation)

    def fits(self, ahead: float, height: float, opening: float, rotation: float) -> bool:
        """Tell whether the claw, open by `opening` [m], can be there and go up from there."""
        pose = self.arm.pose_at(self.tip(ahead, height, rotation), opening)
        lifted = self.arm.pose_at(self.tip(ahead, height + LIFT, rotation), opening)
        if isinstance(pose, Unreachable) or isinstance(lifted, Unreachable):
            return False
        return self.arm.clearance(pose).distance >= MARGIN + SPARE


@lru_cache(maxsize=512)
def _room(claw: Claw, height: float, opening: float, rotation: float) -> Room | None:
    def fits(way: float) -> bool:
        return claw.fits(way, height, opening, rotation)

    ways = [i * STEP for i in range(1, 2 + int(claw.longest / STEP))]
    run = _longest_run([fits(way) for way in ways])
    if run is None:
        return None
    first, last = ways[run[0]], ways[run[1]]
    return Room(_end(fits, first, first - STEP), _end(fits, last, last + STEP))


def _longest_run(fits: list[bool]) -> tuple[int, int] | None:
    """Return the first and the last index of the longest unbroken run of True."""
    best: tuple[int, int] | None = None
    start = 0
    for i, fit in enumerate(fits):
        if not fit:
            start = i + 1
        elif best is None or i - start > best[1] - best[0]:
            best = start, i
    return best


def _end(fits: Callable[[float], bool], inside: float, outside: float) -> float:
    """Return the last way that fits between one that does and one that does not, by halving."""
    while abs(outside - inside) > EXACT:
        middle = (inside + outside) / 2.0
        if fits(middle):
            inside = middle
        else:
            outside = middle
    return inside
