"""Where the base stands to grip, and what its camera sees from there and from the last look."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.obstacle import into
from tapreach.tasks.fetch.stand import LEAST_STRETCH, stances, upright
from tasks.fetch.worlds import BODY, size_at

STANCES = tuple(stances(size_at(0.0, 0.0), BODY.claw, BODY.sight))
poses = st.builds(PlanarPose, st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))
places = st.tuples(st.floats(-3, 3), st.floats(-3, 3))


def test_arm_straight_ahead_is_tried_first():
    assert STANCES[0].rotation == 0.0
    assert STANCES[0].thing_in_base[1] == pytest.approx(BODY.claw.turret[1])


@settings(max_examples=80)
@given(poses, places, st.sampled_from(STANCES))
def test_turn_and_advance_bring_the_thing_before_the_arm(pose, place, stance):
    step = stance.approach_from(pose, np.array(place))
    if step is None:
        assert math.dist(place, (pose.x, pose.y)) <= abs(stance.thing_in_base[1]) + 1e-6
        return
    in_base = into(pose.after(step), np.array([place]))[0]
    np.testing.assert_allclose(in_base, stance.thing_in_base, atol=1e-9)


@settings(max_examples=40)
@given(st.sampled_from(STANCES))
def test_tips_lie_on_the_line_from_the_turret_to_the_thing(stance):
    before, tip = stance.tips(BODY.claw)
    np.testing.assert_allclose(tip[:2], stance.thing_in_base, atol=1e-12)
    ahead = np.array([math.cos(stance.rotation), math.sin(stance.rotation)])
    np.testing.assert_allclose(before[:2] - BODY.claw.turret, stance.grip.pre_grasp * ahead, atol=1e-12)
    assert before[2] == tip[2] == stance.grip.height


@pytest.mark.parametrize(("width", "height"), [(0.03, 0.05), (0.066, 0.115), (0.066, 0.21), (0.05, 0.3)])
def test_last_look_is_the_nearest_at_which_the_whole_thing_is_seen(width, height):
    size = size_at(0.0, 0.0, width=width, height=height)
    stance = next(stances(size, BODY.claw, BODY.sight))
    assert stance.stretch is not None
    assert stance.stretch >= LEAST_STRETCH
    here = PlanarPose()
    at_last_look = upright(size, stance.thing_in_base + np.array([stance.stretch, 0.0]))
    assert BODY.sight.is_whole(at_last_look, here)
    if stance.stretch > LEAST_STRETCH + 0.02:
        nearer = upright(size, stance.thing_in_base + np.array([stance.stretch - 0.02, 0.0]))
        assert not BODY.sight.is_whole(nearer, here)


def test_thing_that_is_nowhere_whole_has_no_such_look():
    pole = size_at(0.0, 0.0, height=2.5)
    assert next(stances(pole, BODY.claw, BODY.sight)).stretch is None


def test_at_the_stand_the_upper_part_is_seen():
    size = size_at(0.0, 0.0, height=0.1)
    stance = STANCES[0]
    seen = BODY.sight.seen_heights(upright(size, stance.thing_in_base), PlanarPose())
    assert seen is not None
    assert 0.02 < seen[0] < 0.09
    assert seen[1] == pytest.approx(0.1)


def test_nothing_is_seen_of_what_stands_behind():
    behind = upright(size_at(-1.0, 0.0), np.array([-1.0, 0.0]))
    assert BODY.sight.seen_heights(behind, PlanarPose()) is None
    assert not BODY.sight.is_whole(behind, PlanarPose())
    assert BODY.sight.is_whole(upright(size_at(1.0, 0.0), np.array([1.0, 0.0])), PlanarPose())


@given(poses)
def test_seeing_does_not_depend_on_the_world(pose):
    size, there = size_at(0.0, 0.0), pose.after(PlanarStep(0.1, 0.8))
    middle = np.array([there.x, there.y])
    off = into(pose, middle[None])[0]
    moved = BODY.sight.seen_heights(upright(size, middle), pose)
    unmoved = BODY.sight.seen_heights(upright(size, off), PlanarPose())
    assert moved is not None
    # What is seen is told in steps of a twentieth; rounding may take one more or less.
    assert moved == pytest.approx(unmoved, abs=1.01 * size.height / 20.0)
