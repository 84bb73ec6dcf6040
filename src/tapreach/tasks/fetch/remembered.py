"""What stood beside the way in earlier looks, and what a new look makes of it.

What comes near leaves the picture below or to the side, long before the robot is past it; and a look now and
then shows nothing where something stands, or something where nothing does. So what one look has shown stays
known until later ones, which should show it, do not.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.convex import segment_distances
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.seen_obstacles import BESIDE, off_way
from tapreach.tasks.fetch.sight import Sight

SURE_LOOKS = 2
"""What so many looks have shown is no chance."""
_PATIENCE = 1
"""What was shown is forgotten after so many more misses than looks, of which SURE_LOOKS count at most."""
SAME_GAP = 0.03
"""What two looks show so near to each other [m] is one thing."""
NEAREST, FARTHEST = 0.3, 1.0
"""A thing on the floor so far from the camera [m] should be seen."""
_SEEN_UP = 0.03
"""Height at which it must be in the picture [m]."""
_SURELY_BESIDE = 0.05


@dataclass(frozen=True, eq=False)
class Look:
    """A look around: its newest view, where the base then was, and where the camera is on the base.

    poses: world_from_base of the views by frame id, as they are now known. goal: what is fetched; it may hide
    what is behind, and only what is near the way to it is looked for.
    """

    frame_id: int
    poses: Mapping[int, PlanarPose]
    sight: Sight
    goal: Obstacle

    @property
    def here(self) -> PlanarPose:
        """Where the base was at the newest view."""
        return self.poses[self.frame_id]

    def is_whole(self, obstacle: Obstacle) -> bool:
        """Tell whether all of an obstacle of the world would be in the picture."""
        ends = (obstacle.start, obstacle.end)
        return all(self.sight.is_in_picture((*end, _SEEN_UP), self.here) for end in ends)

    def should_show(self, obstacle: Obstacle, found: Sequence[Obstacle]) -> bool:
        """Tell whether an obstacle of the world would be seen if it stood there, beside what was `found`."""
        camera = self.sight.place_on_floor(self.here)
        ways = np.linalg.norm(np.array([obstacle.start, obstacle.end]) - camera, axis=1)
        if not self.is_whole(obstacle) or ways.min() < NEAREST or ways.max() > FARTHEST:
            return False
        if off_way(obstacle, camera, self.goal.centre) > BESIDE - _SURELY_BESIDE:
            return False
        return not any(_stands_before(other, obstacle, camera) for other in (*found, self.goal))


@dataclass(frozen=True, eq=False)
class Remembered:
    """An obstacle in the frame of the base at the view `frame_id`, by the wheels at world_from_base.

    looks: how many have shown it. missed: how many since then should have, and did not.
    """

    in_base: Obstacle
    frame_id: int
    world_from_base: PlanarPose
    looks: int = 1
    missed: int = 0

    @property
    def is_sure(self) -> bool:
        """True for what more than one look has shown."""
        return self.looks >= SURE_LOOKS

    def in_world(self, poses: Mapping[int, PlanarPose]) -> Obstacle:
        """Return it in the world, by where its view is now known to have been taken, if that is known."""
        world_from_base = poses.get(self.frame_id, self.world_from_base)
        return self.in_base.seen_from(world_from_base.inverse())


def after_look(known: Sequence[Remembered], found: Sequence[Obstacle], look: Look) -> tuple[Remembered, ...]:
    """Return what is known once a look has shown `found` (in the world), the newest first.

    What it shows takes the place of what was known there, but not of what is only partly in the picture. What
    it should show and does not is forgotten after two misses, three where SURE_LOOKS have shown it: one look
    in six misses what stands there.
    """
    looks, kept, is_part = [1] * len(found), list[Remembered](), [False] * len(found)
    for each in known:
        there = each.in_world(look.poses)
        same = [i for i, new in enumerate(found) if _gap(new, there) < SAME_GAP]
        if not same:
            missed = each.missed + int(look.should_show(there, found))
            if missed < min(each.looks, SURE_LOOKS) + _PATIENCE:
                kept.append(replace(each, missed=missed))
        elif look.is_whole(there):
            for i in same:
                looks[i] = max(looks[i], each.looks + 1)
        else:
            kept.append(replace(each, looks=each.looks + 1, missed=0))
            for i in same:
                is_part[i] = is_part[i] or there.may_be_at(found[i].centre, there.radius)
    new = [
        Remembered(each.seen_from(look.here), look.frame_id, look.here, count)
        for each, count, part in zip(found, looks, is_part, strict=True)
        if not part
    ]
    return (*new, *kept)


def _gap(one: Obstacle, other: Obstacle) -> float:
    """Return the way between two obstacles [m], below 0 where they overlap."""
    apart = segment_distances(one.start[None], one.end[None], other.start[None], other.end[None])[0, 0]
    return float(apart) - one.radius - other.radius


def _stands_before(other: Obstacle, obstacle: Obstacle, camera: FloatArray) -> bool:
    centre = obstacle.centre
    apart = segment_distances(camera[None], centre[None], other.start[None], other.end[None])[0, 0]
    return bool(apart < other.radius + obstacle.radius)
