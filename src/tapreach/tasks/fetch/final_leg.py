"""From some place: one turn and one straight advance to a stand before the thing, if that is free."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.estimation.footprint import aside_of
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.tasks.fetch.approach import NEAR_SHARE, Leg
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.passage import Passage
from tapreach.tasks.fetch.stand import LEAST_STRETCH, Stance, stances, upright
from tapreach.tasks.fetch.thing import ThingSize

NEVER_WHOLE_STRETCH = 0.25
"""Last look before a thing that is nowhere whole in the picture [m]."""
_WHOLE_WITHIN = 0.03
_LEAST_LEG = 0.02
NOT_WHOLE_SECONDS, SIDE_SECONDS, TURNED_ARM_SECONDS = 8.0, 6.0, 3.0
"""What is worth driving longer for [s]: the whole thing in the last picture; each radian less away from the
side that was looked at; an arm straight ahead."""
OTHERWISE_SECONDS = 12.0
"""At the last look another way of standing is worth it only where it is so much better [s]: or the robot
turns to and fro between two that are alike.
"""
_AT_LAST_LOOK = 0.1
IN_VAIN_SECONDS = 40.0
"""What a grasp in vain takes, or a look from yet another side [s]."""
NEW_SIDE = math.radians(30.0)
"""A look from so far beside all others tells something new."""
ROOM_BESIDE = 0.008
"""With so much room [m] in all a box is gripped though the claw comes a few millimetres off its middle."""
LIKELY = 0.5
"""From a side that tells nothing new it must fit with this probability."""


@dataclass(frozen=True)
class FinalLeg:
    """From `start`: `first` to the last look, `stretch` [m] straight on to stand by `stance`.

    cost: seconds of driving, and what else speaks against it in seconds.
    """

    start: PlanarPose
    first: PlanarStep
    stretch: float
    stance: Stance
    is_whole: bool
    side: float
    cost: float

    @property
    def last_look(self) -> PlanarPose:
        """Where the thing is looked at for the last time."""
        return self.start.after(self.first)

    @property
    def stand(self) -> PlanarPose:
        """Where it is gripped from."""
        return self.last_look.after(PlanarStep(0.0, self.stretch))


@dataclass(frozen=True)
class Blocked:
    """Why not: what is in the way of 'turn', 'way' or 'claw'; nothing is where the thing is too 'near' by
    `missing` [m], or it fits the claw too improbably from that `side`.
    """

    of: str
    by: Obstacle | None
    missing: float = 0.0


@dataclass(frozen=True)
class Sides:
    """From where a thing is to be gripped; directions in the world [rad].

    missed_from: not from about there, where the claw closed in vain. kept: how servo A was planned to stand
    before [rad], None for no plan. least_fit: only from where it fits the claw with this probability, and
    from a new side, or likely; 0: from anywhere.
    """

    missed_from: tuple[float, ...] = ()
    kept: float | None = None
    least_fit: float = 0.0


ANY_SIDE = Sides()


@dataclass(frozen=True)
class Goal:
    """The thing in the frame of the base at the start: middle (2,) [m].

    world_heading: of that base in the world [rad].
    """

    size: ThingSize
    middle: FloatArray
    body: Body
    passage: Passage
    world_heading: float = 0.0
    sides: Sides = ANY_SIDE

    @cached_property
    def seen_along(self) -> float:
        """Direction of the line of sight across which the width is known [rad]."""
        if self.size.seen_along is not None:
            return self.size.seen_along - self.world_heading
        return math.atan2(self.middle[1], self.middle[0])

    def fits(self, side: float, room: float = 0.0) -> float:
        """Return how probably it fits the claw that comes from so far beside that line of sight [rad], with
        so much room [m] in all.
        """
        along = self.seen_along + side + self.world_heading
        return self.size.footprint.fits(along, self.body.claw.opens_to - room)

    def side_seconds(self, side: float) -> float:
        """Return what speaks against a side [s]."""
        return SIDE_SECONDS * abs(side) + IN_VAIN_SECONDS * (1.0 - self.fits(side, ROOM_BESIDE))

    @cached_property
    def stances(self) -> tuple[Stance, ...]:
        """All ways of standing before it, the arm straight ahead first."""
        return tuple(stances(self.size, self.body.claw, self.body.sight))

    def final_legs(self, start: PlanarPose) -> list[FinalLeg | Blocked]:
        """Return for each stance the legs from `start`, or why not."""
        return [self.final_leg(start, stance) for stance in self.stances]

    def sees(self, poses: tuple[PlanarPose, ...]) -> bool:
        """Tell whether the thing's middle is in the picture at both poses."""
        place = (*self.middle, self.size.foot + self.size.height / 2.0)
        return all(self.body.sight.is_in_picture(place, pose) for pose in poses)

    def seen_from(self, pose: PlanarPose) -> tuple[float, float] | None:
        """Return from which to which height its front is in the picture [m]; None for nothing of it."""
        return self.body.sight.seen_heights(upright(self.size, self.middle), pose)

    def final_leg(self, start: PlanarPose, stance: Stance) -> FinalLeg | Blocked:
        """Return the legs from `start` to stand by `stance`, or why not."""
        step = stance.approach_from(start, self.middle)
        least = LEAST_STRETCH if stance.stretch is None else min(stance.stretch, LEAST_STRETCH)
        if step is None or step.advance < least:
            distance = math.hypot(self.middle[0] - start.x, self.middle[1] - start.y)
            return Blocked("near", None, float(np.hypot(*stance.thing_in_base)) + least - distance)
        wanted = NEVER_WHOLE_STRETCH if stance.stretch is None else stance.stretch
        stretch = min(wanted, step.advance)
        if step.advance - stretch < _LEAST_LEG:
            stretch = step.advance
        first = PlanarStep(step.turn, step.advance - stretch)
        is_whole = stance.stretch is not None and stretch >= stance.stretch - _WHOLE_WITHIN
        stand_heading = start.heading + step.turn
        side = wrapped(stand_heading + stance.rotation - self.seen_along)
        cost = self._cost(first, stretch, stance, is_whole, side)
        found = FinalLeg(start, first, stretch, stance, is_whole, side, cost)
        return self._blocked(found) or found

    def _blocked(self, found: FinalLeg) -> Blocked | None:
        passage, turned = self.passage, found.start.after(PlanarStep(found.first.turn, 0.0))
        if not self._is_worth(found.side):
            return Blocked("side", None)
        if (by := passage.in_the_way_of_turn(found.start, found.first.turn)) is not None:
            return Blocked("turn", by)
        if (by := passage.in_the_way_of_advance(turned, found.first.advance)) is not None:
            return Blocked("way", by)
        if (by := passage.in_the_way_of_advance(found.last_look, found.stretch)) is not None:
            return Blocked("way", by)
        if (by := passage.in_the_way_of_claw(found.last_look, found.stand, found.stance)) is not None:
            return Blocked("claw", by)
        return None

    def _is_worth(self, side: float) -> bool:
        along, least_fit = self.seen_along + side + self.world_heading, self.sides.least_fit
        if any(aside_of(along, missed) < NEW_SIDE for missed in self.sides.missed_from):
            return False
        if least_fit == 0.0:
            return True
        is_new = self.size.aside_of_looks(along) >= NEW_SIDE
        return self.fits(side) >= max(least_fit, 0.0 if is_new else LIKELY)

    def _cost(self, first: PlanarStep, stretch: float, stance: Stance, is_whole: bool, side: float) -> float:
        base = self.body.base
        seconds = Leg(first, 1.0, True).seconds(base)
        seconds += Leg(PlanarStep(0.0, stretch), NEAR_SHARE, True).seconds(base)
        seconds += 0.0 if is_whole else NOT_WHOLE_SECONDS
        seconds += TURNED_ARM_SECONDS * float(stance.rotation != 0.0)
        if self.sides.kept is not None and first.advance < _AT_LAST_LOOK:
            seconds += OTHERWISE_SECONDS * float(stance.rotation != self.sides.kept)
        return seconds + self.side_seconds(side)
