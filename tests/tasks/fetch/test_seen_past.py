"""Nothing stands before a thing that is seen down to the floor, but what the camera looks over or past."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.seen_past import is_seen_past
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tasks.fetch.worlds import ROBOT, moved, moved_obstacle, obstacle_at, thing_at

HERE = PlanarPose()


def seen(thing: Thing, along: float = 0.0) -> Thing:
    assert isinstance(thing.size, ThingSize)
    return replace(thing, size=replace(thing.size, seen_along=along))


CAN = seen(thing_at(0.45, 0.0, width=0.06))
GLEAM = obstacle_at("a gleam", 0.37, 0.0, 0.015)


def test_gleam_right_before_the_thing_is_not_there() -> None:
    assert is_seen_past(GLEAM, HERE, CAN, ROBOT)


@pytest.mark.parametrize(
    ("x", "y"),
    [(0.37, 0.05), (0.37, -0.05), (0.5, 0.0), (0.2, 0.0)],
    ids=["left", "right", "behind", "under"],
)
def test_what_does_not_hide_the_foot_may_stand_there(x: float, y: float) -> None:
    assert not is_seen_past(obstacle_at("something", x, y, 0.015), HERE, CAN, ROBOT)


def test_thing_of_unknown_or_hidden_foot_or_seen_from_elsewhere_tells_nothing() -> None:
    assert isinstance(CAN.size, ThingSize)
    unknown = replace(CAN, size=NoSize("not measured"))
    lifted = replace(CAN, size=replace(CAN.size, foot=0.03))
    for thing in (unknown, lifted, seen(CAN, along=1.0)):
        assert not is_seen_past(GLEAM, HERE, thing, ROBOT)


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(-3.0, 3.0), st.floats(0.1, 0.5))
def test_it_does_not_depend_on_where_the_world_begins(x: float, y: float, turn: float, ahead: float) -> None:
    pose = PlanarPose(x, y, turn)
    there = obstacle_at("something", ahead, 0.01, 0.015)
    thing = seen(moved(CAN, pose), along=turn)
    assert np.isfinite(thing.point_in_world).all()
    before = is_seen_past(there, HERE, CAN, ROBOT)
    assert is_seen_past(moved_obstacle(there, pose), pose, thing, ROBOT) == before
