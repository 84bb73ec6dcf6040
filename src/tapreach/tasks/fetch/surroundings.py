"""What a fetch knows to stand around it: what it was told, and what its looks on the way have shown."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.fetch.later_pictures import LaterPicture, later_pictures
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings
from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.fetch.remembered import SURE_LOOKS, Look, Remembered, after_look
from tapreach.tasks.fetch.seen_obstacles import own_room, seen_obstacles
from tapreach.tasks.fetch.seen_past import is_seen_past
from tapreach.tasks.fetch.sight import Sight
from tapreach.tasks.fetch.thing import Thing
from tapreach.tasks.sighting import Sighting, is_apart
from tapreach.tasks.task import TaskContext

_CLEAR_OF_ROBOT = 0.005
"""What was seen is so far from where the robot stands [m] at least, or it would not stand there."""
_LEAST_RADIUS = 0.01
_FEWEST_VIEWS = 3
"""Fewer show nothing, and deny nothing."""
_LOOK_APART, _TURN_APART = 0.03, 0.1
"""A look from nearer to the last one [m, rad] is the same look."""
_BUMPED_RADIUS = 0.04
"""Half of how wide that is taken to be what blocked the robot [m]."""
_NO_VIEW = -1
_SURE, _MOST_OFF = 2.0, 0.05
"""What is seen within so many sigmas of the thing's place beside it, at most so far [m], is taken for the
thing: seen from another side it would be driven round for ever.
"""
_BY_THE_THING = 0.05
"""What one look alone shows so near the thing [m] may be its shadow, or its gleam on the floor."""


@dataclass
class SeenAround:
    """What the looks of one fetch have shown; in the world of the present odometry.

    poses: of the views, by frame id, as the newest look knows them.
    """

    known: tuple[Remembered, ...] = ()
    poses: dict[int, PlanarPose] | None = None
    newest: int | None = None

    async def look(self, context: TaskContext, located: LocatedPoint, thing: Thing) -> None:
        """Take what the pictures of the sightings show, and those taken since the thing was last seen; those
        that were looked at before say nothing new.
        """
        later = later_pictures(context, located.sightings[-1])
        views: list[Sighting | LaterPicture] = [*located.sightings, *later]
        newest = views[-1]
        if len(views) < _FEWEST_VIEWS or self._was_looked_at(newest.frame_id, newest.world_from_base):
            return
        self.newest = newest.frame_id
        self.poses = {each.frame_id: each.world_from_base for each in views}
        found = await seen_obstacles(context, located, thing, later)
        middle, radius = own_room(thing)
        goal = Obstacle("it", middle, middle, radius, 0.0)
        look = Look(newest.frame_id, self.poses, Sight.of(context.description), goal)
        self.known = after_look(self.known, found, look)

    def _was_looked_at(self, frame_id: int, here: PlanarPose) -> bool:
        """Tell whether the newest look was at this picture, or from there: at rest nothing new is seen."""
        if self.newest is None or self.poses is None:
            return False
        before = self.poses[self.newest]
        return frame_id == self.newest or not is_apart(before, here, _LOOK_APART, _TURN_APART)

    def bumped_into(self, here: PlanarPose, front: float) -> None:
        """Remember what the base pushes against in vain at `here`, `front` [m] ahead of its wheel axis."""
        place = np.array([front + _BUMPED_RADIUS, 0.0])
        unseen = Obstacle("what blocked the robot", place, place, _BUMPED_RADIUS, 0.0)
        self.known = (Remembered(unseen, _NO_VIEW, here, SURE_LOOKS), *self.known)

    def in_world(self) -> tuple[Obstacle, ...]:
        """Return all that was seen where it is now known to stand."""
        return tuple(each.in_world(self.poses or {}) for each in self.known)

    def obstacles(self, here: PlanarPose, thing: Thing, description: RobotDescription) -> list["Seen"]:
        """Return what stands around, without the robot at `here` and the thing itself."""
        middle, radius = own_room(thing)
        radius += min(_SURE * thing.place_sd, _MOST_OFF)
        outline = Outline.of(description).at(here)
        found = []
        for each in self.known:
            there = each.in_world(self.poses or {})
            beside = _beside(there, float(Surroundings.of([there]).clearances(outline)[0]))
            own = radius if each.is_sure else radius + _BY_THE_THING
            if is_seen_past(there, here, thing, description):
                continue
            if beside is not None and not there.may_be_at(middle, own - there.spread):
                found.append(Seen(beside, each.is_sure))
        return found


@dataclass(frozen=True, eq=False)
class Seen:
    """An obstacle of the world; is_sure: more than one look has shown it."""

    obstacle: Obstacle
    is_sure: bool

    @property
    def squeezed(self) -> Obstacle:
        """The obstacle without what its place may be off."""
        return replace(self.obstacle, spread=0.0)


@dataclass(frozen=True)
class KeptClearOf:
    """What a way keeps clear of; `drifts`: also of what odometry may be off by there."""

    obstacles: tuple[Obstacle, ...]
    drifts: bool = True


def to_plan_round(told: Sequence[Obstacle], seen: Sequence[Seen]) -> list[KeptClearOf]:
    """Return what a way is sought around, until one is found: all, as large as it may be; what was seen just
    as it was seen, then as if no drift came to it, for each leg is planned anew; so only what was seen more
    than once; only what was told.

    What is seen may be wrong, and shall not end a fetch.
    """
    if not seen:
        return [KeptClearOf(tuple(told))]
    all_squeezed = tuple(each.squeezed for each in seen)
    sure = tuple(each.squeezed for each in seen if each.is_sure)
    ways = [
        KeptClearOf((*told, *(each.obstacle for each in seen))),
        KeptClearOf((*told, *all_squeezed)),
        KeptClearOf((*told, *all_squeezed), drifts=False),
    ]
    if 0 < len(sure) < len(seen):
        ways.append(KeptClearOf((*told, *sure), drifts=False))
    return [*ways, KeptClearOf(tuple(told))]


def _beside(obstacle: Obstacle, clearance: float) -> Obstacle | None:
    """Return an obstacle made so small that it is `clearance` [m] or more from the robot; None for what the
    robot would stand on.
    """
    lacking = max(0.0, _CLEAR_OF_ROBOT - clearance)
    spread = max(0.0, obstacle.spread - lacking)
    radius = obstacle.radius - max(0.0, lacking - obstacle.spread)
    if radius < _LEAST_RADIUS or not np.isfinite(radius):
        return None
    return replace(obstacle, radius=radius, spread=spread)
