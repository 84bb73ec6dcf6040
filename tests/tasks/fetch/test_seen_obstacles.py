"""What stands on the way and beside it, in the rendered simulator, from a few pictures on the way."""

from dataclasses import replace

import numpy as np
import pytest

from tapreach.drivers.sim.truth import WorldTruth
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.fetch.later_pictures import LaterPicture
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.seen_obstacles import obstacles_in_views
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tapreach.tasks.sighting import Sighting
from tasks.fetch.test_size import DESCRIPTION, film, followed, on_front

THING = "juice"


def located(sightings: list[Sighting]) -> LocatedPoint:
    return estimate(sightings, DESCRIPTION, with_advice=False)


def thing_of(found: LocatedPoint, truth: WorldTruth, pose: PlanarPose) -> Thing:
    """Return the thing as it would be measured, in the world of the sightings."""
    assert found.point_in_world is not None and found.point_cov_in_world is not None
    there = truth.object(THING)
    in_base = truth.base_pose.to_rigid().inv().apply(np.array(there.centre_in_world))
    axis = np.asarray(pose.to_rigid().apply(in_base))
    width, cov = float(np.mean(there.size[:2])), found.point_cov_in_world
    size = ThingSize(width, 0.003, there.size[2], 0.005, 0.0, axis, cov)
    return Thing(found.point_in_world, cov, size)


def seen() -> tuple[tuple[Obstacle, ...], WorldTruth]:
    shots, robot = film("room")
    sightings = followed(shots, on_front(THING, shots, robot))
    found, truth = located(sightings), shots[-1][1]
    jpegs = {frame.frame_id: frame.jpeg for frame, _ in shots}
    thing = thing_of(found, truth, sightings[-1].world_from_base)
    return obstacles_in_views(found, thing, jpegs, DESCRIPTION), truth


def seen_later() -> tuple[tuple[Obstacle, ...], WorldTruth]:
    """Return what is seen when the thing was followed in the first half of the pictures only."""
    shots, robot = film("room")
    sightings = followed(shots, on_front(THING, shots, robot))
    half = len(sightings) // 2
    found, truth = located(sightings[:half]), shots[-1][1]
    jpegs = {frame.frame_id: frame.jpeg for frame, _ in shots}
    later = [LaterPicture(each.frame_id, each.world_from_base) for each in sightings[half:]]
    thing = thing_of(found, truth, sightings[-1].world_from_base)
    return obstacles_in_views(found, thing, jpegs, DESCRIPTION, later), truth


def off(obstacle: Obstacle, truth: WorldTruth, name: str) -> float:
    """Return the way from the middle of a thing to what was seen; sightings are in the world of the truth."""
    middle = np.array(truth.object(name).centre_in_world[:2])
    return float(np.linalg.norm(obstacle.centre - middle))


def test_what_stands_on_the_way_is_seen_where_it_stands() -> None:
    obstacles, truth = seen()
    for name in ("tea", "red can"):
        assert min(off(each, truth, name) for each in obstacles) < 0.05, name


def test_what_stands_is_seen_too_in_pictures_in_which_the_thing_is_not_followed() -> None:
    obstacles, truth = seen_later()
    for name in ("tea", "red can"):
        assert min(off(each, truth, name) for each in obstacles) < 0.05, name


def test_the_thing_itself_and_the_free_floor_are_no_obstacles() -> None:
    obstacles, truth = seen()
    start = np.array([truth.base_pose.x, truth.base_pose.y])
    there = np.array(truth.object(THING).centre_in_world[:2])
    for each in obstacles:
        assert off(each, truth, THING) > 0.04
        named = [thing.name for thing in truth.objects if off(each, truth, thing.name) < 0.1]
        on_way = float(np.linalg.norm(each.centre - start) + np.linalg.norm(each.centre - there))
        assert named or on_way > np.linalg.norm(there - start) + 0.03


@pytest.mark.parametrize("kept", [0, 1])
def test_nothing_is_seen_where_pictures_are_no_longer_kept(kept: int) -> None:
    shots, robot = film("room")
    sightings = followed(shots, on_front(THING, shots, robot))
    found = located(sightings)
    thing = replace(thing_of(found, shots[-1][1], sightings[-1].world_from_base), size=NoSize("not measured"))
    jpegs = {frame.frame_id: frame.jpeg for frame, _ in shots[:kept]}
    assert obstacles_in_views(found, thing, jpegs, DESCRIPTION) == ()
