"""What else stands near the way to a thing, by the pictures in which the thing was followed."""

from collections.abc import Mapping, Sequence

import numpy as np

from tapreach.errors import FrameError
from tapreach.geometry.convex import distances_from_polygon
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.fetch.later_pictures import LaterPicture
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.standing_clusters import clustered
from tapreach.tasks.fetch.standing_points import StandingPoints, standing_points
from tapreach.tasks.fetch.standing_views import standing_views
from tapreach.tasks.fetch.thing import Thing, ThingSize
from tapreach.tasks.task import TaskContext

BESIDE, BEYOND = 0.45, 0.12
"""So far beside the straight way, and beyond the thing, others matter [m]."""
ITS_OWN = 0.03
"""What is so near around the thing [m] may be part of it."""
_SUPPOSED_RADIUS = 0.05
_UNDER_ROBOT = 0.12
_MOST = 16


async def seen_obstacles(
    context: TaskContext, located: LocatedPoint, thing: Thing, later: Sequence[LaterPicture] = ()
) -> tuple[Obstacle, ...]:
    """Return what stands near the way from the newest view to the thing, in the world of its odometry.

    later: pictures in which the thing was not seen any more.

    Only what was seen from two places is found, and nothing where pictures are no longer kept.
    """
    jpegs: dict[int, bytes] = {}
    for frame_id in [each.frame_id for each in located.sightings] + [each.frame_id for each in later]:
        try:
            jpegs[frame_id] = context.frames.get(frame_id).jpeg
        except FrameError:
            continue
    return await context.compute.call(obstacles_in_views, located, thing, jpegs, context.description, later)


def obstacles_in_views(
    located: LocatedPoint,
    thing: Thing,
    jpegs: Mapping[int, bytes],
    description: RobotDescription,
    later: Sequence[LaterPicture] = (),
) -> tuple[Obstacle, ...]:
    """Return what stands near the way to the thing by the pictures of the sightings that are kept (by frame
    id), and of `later` ones, the nearest to the way first; a pure function.
    """
    point = located.point_in_world
    if point is None:
        return ()
    kept = [each for i, each in enumerate(located.sightings) if i not in located.rejected_views]
    views = standing_views([*kept, *later], located.base_from_camera, point, jpegs, description)
    newest = (later[-1] if later else located.sightings[-1]).world_from_base
    here, there, own = np.array([newest.x, newest.y]), *own_room(thing)
    others = _without_own(standing_points(views), there, own)
    found = [each for each in clustered(others) if _from(here, each.centre) > _UNDER_ROBOT]
    ranked = sorted(((off_way(each, here, there), i) for i, each in enumerate(found)))
    return tuple(found[i] for off, i in ranked if off < BESIDE)[:_MOST]


def own_room(thing: Thing) -> tuple[FloatArray, float]:
    """Return the thing's middle (2,) and the radius within which all is its own."""
    if isinstance(thing.size, ThingSize):
        return np.asarray(thing.size.axis_in_world[:2]), thing.size.width / 2.0 + ITS_OWN
    return np.asarray(thing.point_in_world[:2]), _SUPPOSED_RADIUS + ITS_OWN


def _without_own(found: StandingPoints, middle: FloatArray, radius: float) -> StandingPoints:
    return found.where(np.linalg.norm(found.points[:, :2] - middle, axis=1) > radius)


def off_way(obstacle: Obstacle, here: FloatArray, there: FloatArray) -> float:
    """Return how far it is from the straight way [m]; infinite beyond the thing."""
    ahead = (there - here) / max(_from(here, there), 1e-9)
    if float((obstacle.centre - there) @ ahead) > BEYOND:
        return float("inf")
    way = np.array([here, there])
    return float(distances_from_polygon(way, obstacle.start[None], obstacle.end[None])[0]) - obstacle.radius


def _from(here: FloatArray, there: FloatArray) -> float:
    return float(np.linalg.norm(there - here))
