"""What ways are sought around: no seen thing stands where the robot does, and none can end a fetch."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings
from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.fetch.remembered import Remembered
from tapreach.tasks.fetch.seen_obstacles import own_room
from tapreach.tasks.fetch.surroundings import KeptClearOf, Seen, SeenAround, to_plan_round
from tasks.fetch.worlds import ROBOT, obstacle_at, thing_at

GOAL = thing_at(1.2, 0.1)
coordinates = st.floats(-0.5, 1.5)
spreads = st.floats(0.0, 0.03)


def seen_at(x: float, y: float, radius: float = 0.03, sd: float = 0.005, looks: int = 1) -> Remembered:
    return Remembered(obstacle_at("something", x, y, radius, sd), 1, PlanarPose(), looks)


def around(*known: Remembered) -> list[Obstacle]:
    return [each.obstacle for each in SeenAround(known).obstacles(PlanarPose(), GOAL, ROBOT)]


@given(coordinates, coordinates, st.floats(0.015, 0.05), spreads)
def test_nothing_seen_stands_where_the_robot_or_the_thing_does(
    x: float, y: float, radius: float, sd: float
) -> None:
    middle, own = own_room(GOAL)
    outline = Outline.of(ROBOT).corners
    for obstacle in around(seen_at(x, y, radius, sd)):
        assert Surroundings.of([obstacle]).clearances(outline)[0] > 0.0
        assert np.linalg.norm(obstacle.centre - middle) > own
        assert obstacle.radius <= radius


def test_what_one_look_shows_close_by_the_thing_is_taken_for_its_shadow_until_another_shows_it() -> None:
    middle, own = own_room(GOAL)
    beside = float(middle[1]) - own - 0.04
    assert around(seen_at(float(middle[0]), beside, radius=0.015, looks=1)) == []
    assert len(around(seen_at(float(middle[0]), beside, radius=0.015, looks=2))) == 1


def test_what_would_hide_the_foot_of_a_thing_that_is_seen_is_not_there() -> None:
    middle, own = own_room(GOAL)
    before = seen_at(float(middle[0]) - own - 0.05, float(middle[1]), radius=0.015, looks=2)
    assert around(before) == []


@pytest.mark.parametrize(("place_sd", "count"), [(0.005, 1), (0.02, 0), (1.0, 0)])
def test_what_is_seen_as_far_beside_as_the_thing_may_be_off_is_the_thing(place_sd: float, count: int) -> None:
    middle, own = own_room(GOAL)
    thing = replace(GOAL, point_cov_in_world=place_sd**2 * np.eye(3))
    beside = seen_at(float(middle[0]), float(middle[1]) + own + 0.035, looks=2)
    assert len(SeenAround((beside,)).obstacles(PlanarPose(), thing, ROBOT)) == count
    apart = seen_at(float(middle[0]), float(middle[1]) + own + 0.08, looks=2)
    assert len(SeenAround((apart,)).obstacles(PlanarPose(), thing, ROBOT)) == 1


def test_what_stands_apart_stays_as_it_was_seen() -> None:
    (obstacle,) = around(seen_at(0.7, -0.3))
    assert np.allclose(obstacle.centre, (0.7, -0.3))
    assert obstacle.radius == 0.03


def test_ways_are_sought_around_ever_less_and_at_last_around_what_is_told_alone() -> None:
    told = [obstacle_at("target 2", 0.5, 0.4)]
    seen = [Seen(obstacle_at("something", 0.6, 0.1), True), Seen(obstacle_at("something", 0.9, -0.1), False)]
    ways = to_plan_round(told, seen)
    assert [len(way.obstacles) for way in ways] == [3, 3, 3, 2, 1]
    assert [way.drifts for way in ways] == [True, True, False, False, True]
    every, squeezed = ways[0].obstacles, ways[1].obstacles
    assert all(a.spread >= b.spread for a, b in zip(every, squeezed, strict=True))
    assert all(way.obstacles[0] is told[0] for way in ways)


def test_without_anything_seen_there_is_one_plan() -> None:
    told = [obstacle_at("target 2", 0.5, 0.4)]
    assert to_plan_round(told, []) == [KeptClearOf(tuple(told))]
