"""A look back at the thing on a way that has taken it out of the picture."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.glance import UNSEEN_WAY, glance
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.thing import Thing
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import obstacle_at, thing_at
from tasks.rig import bare_context


class Standing(FetchRun):
    """A fetch whose thing stands where it is said to."""

    known_to_stand: Thing

    def thing(self) -> Thing:
        return self.known_to_stand


def standing(here: PlanarPose, thing: Thing, *others: Obstacle) -> FetchRun:
    context = bare_context()
    context.poses.add(1, here)
    run = Standing(context, FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO), others, None)  # type: ignore[arg-type]
    run.known_to_stand = thing
    return run


@given(st.floats(-1.9, 1.9), st.floats(0.5, 2.0))
def test_robot_turns_to_face_the_thing(bearing: float, distance: float) -> None:
    thing = thing_at(distance * math.cos(bearing), distance * math.sin(bearing))
    leg = glance(standing(PlanarPose(), thing), UNSEEN_WAY)
    assert leg is not None and leg.step.advance == 0.0
    x, y, _ = thing.point_in_world
    assert leg.step.turn == pytest.approx(math.atan2(y, x))


def test_thing_seen_lately_or_near_is_not_looked_back_at() -> None:
    assert glance(standing(PlanarPose(), thing_at(0.2, 0.9)), UNSEEN_WAY / 2.0) is None
    assert glance(standing(PlanarPose(), thing_at(0.1, 0.25)), UNSEEN_WAY) is None


def test_nobody_turns_into_what_is_known_to_stand_beside() -> None:
    beside = obstacle_at("box", -0.12, 0.12, 0.02)
    assert glance(standing(PlanarPose(), thing_at(0.0, 0.9), beside), UNSEEN_WAY) is None
    assert glance(standing(PlanarPose(), thing_at(0.0, 0.9), obstacle_at("box", -0.6, 0.5)), UNSEEN_WAY)
