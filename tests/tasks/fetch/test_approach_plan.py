"""Ways to a stand: clear of known things, the same in every world, mirrored in a mirror, refused by name."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.approach import Approach, NoWay
from tapreach.tasks.fetch.approach_plan import is_same, plan_approach
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.final_leg import Sides
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings, into, out_of
from tapreach.tasks.fetch.passage import CLEAR, TOUCH, claw_at
from tapreach.tasks.fetch.thing import ThingSize
from tasks.fetch.worlds import (
    BODY,
    gap,
    mirrored_robot,
    moved,
    moved_obstacle,
    obstacle_at,
    poses_along,
    random_obstacles,
    size_at,
    thing_at,
)

HERE = PlanarPose()
MIRRORED = Body.of(mirrored_robot())
worlds = settings(max_examples=25, deadline=None)
afar = st.tuples(st.floats(0.5, 2.5), st.floats(-1.0, 1.0))


OPENS = BODY.claw.opens_to


def planned(size: ThingSize, others=(), body=BODY, **more) -> Approach | NoWay:
    return plan_approach(size, others, HERE, body, **more)


def goal_of(size: ThingSize) -> Obstacle:
    return Obstacle("goal", size.axis_in_world[:2], size.axis_in_world[:2], size.width / 2.0, 0.0)


def around(x: float, radius: float, eighth: int) -> tuple[float, float]:
    angle = eighth * math.pi / 4.0
    return x + radius * math.cos(angle), radius * math.sin(angle)


@worlds
@given(afar)
def test_way_ends_with_the_thing_before_the_arm(place):
    found = planned(size_at(*place))
    assert isinstance(found, Approach)
    in_base = into(found.stand, np.array([place]))[0]
    np.testing.assert_allclose(in_base, found.stance.thing_in_base, atol=1e-9)
    assert found.stand.heading == found.last_look.heading
    assert found.is_whole_at_last_look


@worlds
@given(afar, random_obstacles())
def test_way_never_comes_near_other_things(place, others):
    size = size_at(*place)
    found = planned(size, others)
    if isinstance(found, NoWay):
        return
    start = Surroundings.of(others).clearances(BODY.outline.corners)
    for other, at_start in zip(others, start, strict=True):
        # What is the thing itself, and a region over the robot itself, are not kept clear of.
        if is_same(other, goal_of(size)) or at_start < TOUCH:
            continue
        assert gap(found, other) >= min(CLEAR, at_start) - 1e-3


@worlds
@given(afar, random_obstacles())
def test_base_never_touches_the_thing_itself(place, others):
    found = planned(size_at(*place), others)
    if isinstance(found, Approach):
        assert gap(found, goal_of(size_at(*place))) > TOUCH - 1e-3


@worlds
@given(afar, random_obstacles(3))
def test_open_claw_goes_past_other_things(place, others):
    size = size_at(*place)
    found = planned(size, others)
    if isinstance(found, NoWay):
        return
    grip, things = found.stance.grip, [each for each in others if not is_same(each, goal_of(size))]
    for ahead in np.linspace(grip.pre_grasp, grip.ahead, 5):
        claw = out_of(found.stand, claw_at(found.stance, float(ahead), BODY))
        assert (Surroundings.of(things).clearances(claw) > 0.0).all()


@worlds
@given(
    afar,
    random_obstacles(3),
    st.builds(PlanarPose, st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)),
)
def test_way_does_not_depend_on_the_world_frame(place, others, pose):
    thing = thing_at(*place)
    there = moved(thing, pose)
    assert isinstance(thing.size, ThingSize)
    assert isinstance(there.size, ThingSize)
    one = planned(thing.size, others)
    other = plan_approach(there.size, [moved_obstacle(each, pose) for each in others], pose, BODY)
    assert type(one) is type(other)
    if isinstance(one, NoWay):
        assert one == other
    elif isinstance(other, Approach):
        assert_same_way([pose.compose(each) for each in one.path], other.path)
        assert one.seconds == pytest.approx(other.seconds, abs=1e-3)


@worlds
@given(afar, random_obstacles(3))
def test_mirrored_robot_in_a_mirrored_world_drives_the_mirrored_way(place, others):
    size = size_at(*place)
    flip = np.array([1.0, -1.0])
    there = replace(size, axis_in_world=size.axis_in_world * [1.0, -1.0, 1.0])
    flipped = [replace(each, start=each.start * flip, end=each.end * flip) for each in others]
    one, other = planned(size, others), planned(there, flipped, MIRRORED)
    assert type(one) is type(other)
    if isinstance(one, Approach) and isinstance(other, Approach):
        assert_same_way([PlanarPose(each.x, -each.y, -each.heading) for each in one.path], other.path)


def assert_same_way(ones, others):
    assert len(ones) == len(others)
    for one, other in zip(ones, others, strict=True):
        np.testing.assert_allclose(
            (one.x, one.y, math.cos(one.heading), math.sin(one.heading)),
            (other.x, other.y, math.cos(other.heading), math.sin(other.heading)),
            atol=1e-6,
        )


def test_free_way_is_one_leg_with_the_thing_in_view():
    found = planned(size_at(1.5, 0.3))
    assert isinstance(found, Approach)
    (leg,) = found.legs
    assert leg.sees_thing
    assert found.round_what == ""
    assert found.last_stretch.step.turn == 0.0
    assert found.last_stretch.share < leg.share
    assert len(poses_along(found)) > 10


def test_what_stands_in_the_way_is_driven_around_and_named():
    found = planned(size_at(1.5, 0.0), [obstacle_at("the box", 0.8, 0.0, 0.15)])
    assert isinstance(found, Approach)
    assert found.round_what == "the box at 0.8 m"
    assert len(found.legs) >= 2


@pytest.mark.parametrize(
    ("others", "reason", "advice"),
    [
        (
            [obstacle_at(f"box {i}", *around(1.5, 0.3, i), 0.1) for i in range(8)],
            "stands behind box",
            "away first",
        ),
        ([obstacle_at("the box", 0.15, 0.1, 0.1)], "the box at 0.2 m touches the robot", "drive clear"),
        (
            [
                obstacle_at("the can", 1.5, 0.09, 0.04),
                obstacle_at("the tin", 1.5, -0.09, 0.04),
                obstacle_at("the jar", 1.59, 0.0, 0.04),
            ],
            "no room for the open claw",
            "away first",
        ),
    ],
)
def test_blocked_way_is_refused_by_name(others, reason, advice):
    found = planned(size_at(1.5, 0.0), others)
    assert isinstance(found, NoWay)
    assert reason in found.reason
    assert advice in found.advice


def test_thing_under_the_robot_is_refused():
    found = planned(size_at(-0.05, 0.0), free_behind=0.5)
    assert isinstance(found, NoWay)
    assert "under the robot" in found.reason


def test_thing_behind_the_robot_is_turned_to():
    found = planned(size_at(-1.2, 0.1))
    assert isinstance(found, Approach)
    assert abs(found.legs[0].step.turn) > math.radians(150.0)


def test_thing_too_near_is_backed_off_from_where_the_floor_behind_is_known():
    found = planned(size_at(0.3, 0.0), free_behind=0.4)
    assert isinstance(found, Approach)
    assert found.legs[0].step.advance < 0.0
    assert found.is_whole_at_last_look


def test_thing_too_near_is_not_backed_off_from_into_the_unknown():
    found = planned(size_at(0.3, 0.0))
    assert isinstance(found, Approach)
    assert all(leg.step.advance >= 0.0 for leg in found.legs)


def test_the_thing_located_twice_is_not_in_its_own_way():
    again = obstacle_at("target 1", 1.51, 0.0, 0.04, 0.02)
    found = planned(size_at(1.5, 0.0), [again])
    assert isinstance(found, Approach)
    assert found.round_what == ""
    assert len(found.legs) == 1


def test_region_over_the_robot_itself_does_not_hold_it():
    vague = Obstacle.around("the box", (0.5, 0.0), np.diag([0.3**2, 1e-4]), 0.03)
    assert isinstance(planned(size_at(0.0, 1.5), [vague]), Approach)


@worlds
@given(st.floats(0.8, 2.5), st.floats(-0.6, 0.6))
def test_another_side_is_one_from_which_the_thing_was_not_looked_at_and_may_fit(x, y):
    size = size_at(x, y, width=0.085).seen_from(HERE)
    least = 0.5 * (size.fits(OPENS) + size.footprint.best_fit(OPENS))
    found = planned(size, sides=Sides(least_fit=least))
    assume(isinstance(found, Approach))
    assert isinstance(found, Approach)
    claw = found.stand.heading + found.stance.rotation
    assert size.aside_of_looks(claw) >= math.radians(30.0)
    assert size.footprint.fits(claw, OPENS) >= least


@worlds
@given(st.floats(0.8, 2.0), st.floats(-2.0, 2.0), st.floats(-3.0, 3.0))
def test_side_counts_from_where_the_width_was_measured(x, sideways, heading):
    size = size_at(x, 0.0, width=0.085)
    # The base has driven aside since; from where it is now the thing is seen from another side already.
    here = PlanarPose(0.0, sideways, heading)
    found = plan_approach(replace(size, seen_along=0.0), [], here, BODY, sides=Sides(least_fit=0.01))
    assume(isinstance(found, Approach))
    assert isinstance(found, Approach)
    claw = math.remainder(2.0 * (found.stand.heading + found.stance.rotation), math.tau) / 2.0
    assert abs(claw) >= math.radians(29.9)


def test_error_of_the_last_stretch_grows_with_it():
    near, far = planned(size_at(1.5, 0.0, height=0.1)), planned(size_at(1.5, 0.0, height=0.3))
    assert isinstance(near, Approach)
    assert isinstance(far, Approach)
    assert far.last_stretch.step.advance > near.last_stretch.step.advance
    assert np.linalg.eigvalsh(far.blind_cov - near.blind_cov)[-1] > 0.0
