"""What is tapped in each run of the bench of fetching, and where the robot stands then.

A thing to be fetched can be grasped and has 6 cm of free floor around it, so that the open claw has room;
nothing is asked of the way to it. What cannot be grasped is put into the room.
"""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.bench.fault_level import DEFAULT, HARD
from tapreach.bench.fetch_plan import Chapter, generator
from tapreach.bench.fetch_scene import cluttered_scene, varied_scene
from tapreach.bench.fetch_ungraspable import Hindrance, ungraspable
from tapreach.bench.places import FLAT, Sought, solids, things_of
from tapreach.bench.stage import Setting, Stage, draw_in
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.scene_checks import Solid, solid_of_object
from tapreach.drivers.sim.truth import SurfacePoint
from tapreach.errors import SetupError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose

CLAW_ROOM = 0.06
"""Of free floor around a thing that is to be fetched [m]."""
HALF_WAY = 0.11
"""Half of how wide the robot's way is [m]."""
_ON_WALL = 0.02
_ROOMS = 20


@dataclass(frozen=True)
class FetchStage:
    """A stage, whether the straight way to the thing is free for the robot, and why it cannot be fetched."""

    stage: Stage
    chapter: Chapter
    is_way_free: bool
    hindrance: Hindrance | None = None


async def draw_fetch_stage(seed: int, chapter: Chapter, number: int, rate_hz: float) -> FetchStage:
    """Return the stage of one run. Raises SetupError when no random room has one."""
    rng = generator(seed, chapter, number)
    for _ in range(_ROOMS):
        try:
            return await _drawn(chapter, number, rate_hz, rng)
        except SetupError:
            continue
    raise SetupError(f"no place for run {number} of {chapter!r} in {_ROOMS} random rooms")


async def _drawn(chapter: Chapter, number: int, rate_hz: float, rng: np.random.Generator) -> FetchStage:
    level = HARD if chapter is Chapter.HARD else DEFAULT
    if chapter is Chapter.REFUSALS:
        thing = ungraspable(rng, list(Hindrance)[number % len(Hindrance)])
        setting = Setting(number, str(thing.hindrance), thing.scene, level, rate_hz)
        stage = await draw_in(setting, [thing.sought], rng, _is_on_it)
        return FetchStage(stage, chapter, True, thing.hindrance)
    name, scene = "random", varied_scene(rng)
    if chapter is Chapter.CLUTTER:
        name, scene = cluttered_scene(rng, number)
    stage = await draw_in(Setting(number, name, scene, level, rate_hz), graspable_things(scene), rng)
    return FetchStage(stage, chapter, is_way_free(stage))


def graspable_things(scene: Scene) -> list[Sought]:
    """Return what can be grasped, stands on the floor and has room for the claw."""
    found = []
    for sought, thing in zip(things_of(scene), scene.objects, strict=True):
        if thing.graspable and thing.up <= FLAT and _has_room(scene, solid_of_object(thing)):
            found.append(sought)
    return found


def is_way_free(stage: Stage) -> bool:
    """Tell whether nothing stands in the robot's straight way to the thing."""
    index = stage.scene.object_names().index(stage.thing)
    there = np.array(stage.scene.objects[index].position)
    start = np.array([stage.start.x, stage.start.y])
    along = (there - start) / np.linalg.norm(there - start)
    across = HALF_WAY * np.array([-along[1], along[0]])
    way = Solid(np.array([start - across, there - across, there + across, start + across]), (0.0, 0.4))
    own = solid_of_object(stage.scene.objects[index])
    return not any(way.overlaps(each) for each in solids(stage.scene) if not _is_same(each, own))


def _has_room(scene: Scene, thing: Solid) -> bool:
    middle = thing.outline.mean(axis=0)
    radius = float(np.linalg.norm(thing.outline - middle, axis=1).max()) + CLAW_ROOM
    room = Solid(_circle(middle, radius), (0.0, 0.2))
    low, high = np.transpose([scene.room.x, scene.room.y])
    if np.any(room.outline < low) or np.any(room.outline > high):
        return False
    return not any(room.overlaps(each) for each in solids(scene) if not _is_same(each, thing))


def _is_on_it(thing: Sought, start: PlanarPose, surface: SurfacePoint) -> bool:
    """Tell whether a pixel on no thing is on what hangs there, and not on what stands before it."""
    if thing.corners_in_world is None:
        return True
    origin, right, up = (thing.corners_in_world[i] for i in (0, 1, 3))
    normal = np.cross(right - origin, up - origin)
    off = float(normal @ (surface.point_in_world - origin)) / float(np.linalg.norm(normal))
    return abs(off) < _ON_WALL


def _is_same(one: Solid, other: Solid) -> bool:
    return one.outline.shape == other.outline.shape and bool(np.allclose(one.outline, other.outline))


def _circle(middle: FloatArray, radius: float, corners: int = 24) -> FloatArray:
    angles = np.arange(corners) * 2.0 * math.pi / corners
    return np.asarray(middle + radius * np.column_stack([np.cos(angles), np.sin(angles)]))
