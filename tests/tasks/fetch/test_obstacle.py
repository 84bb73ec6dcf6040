"""The room that things take and that the robot takes, seen from above."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.obstacle import UNKNOWN_RADIUS, Obstacle, Surroundings, into, out_of
from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.fetch.thing import NoSize, Thing
from tapreach.tasks.target import Target, TargetSource
from tasks.fetch.worlds import BODY, ROBOT, obstacle_at, thing_at

poses = st.builds(PlanarPose, st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))
sds = st.floats(0.0, 0.2)


@given(st.floats(-3, 3), sds, sds, st.floats(0.0, 0.3))
def test_obstacle_holds_the_whole_region_around_a_thing(angle, first, second, radius):
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    root = turn @ np.diag([first, second])
    obstacle = Obstacle.around("it", (1.0, -0.5), root @ root.T, radius)
    around = np.linspace(0.0, 2.0 * math.pi, 60)
    # 95 % of a plane normal distribution lie within sqrt(5.991) sigmas.
    ellipse = [1.0, -0.5] + math.sqrt(5.991) * np.column_stack([np.cos(around), np.sin(around)]) @ root.T
    clear = Surroundings.of([obstacle])
    assert all(clear.clearances(place[None])[0] <= -radius + 1e-4 for place in ellipse)


@given(poses, st.floats(-1, 1), st.floats(-1, 1))
def test_into_and_out_of_a_frame_are_inverse_and_agree_with_poses(pose, x, y):
    there = pose.compose(PlanarPose(x, y))
    np.testing.assert_allclose(out_of(pose, np.array([(x, y)]))[0], (there.x, there.y), atol=1e-12)
    np.testing.assert_allclose(into(pose, np.array([(there.x, there.y)]))[0], (x, y), atol=1e-12)


def test_known_thing_takes_its_corners_and_unknown_a_hand():
    thing = thing_at(1.0, 0.2, width=0.1, width_sd=0.01)
    assert Obstacle.of_thing("box", thing).radius == pytest.approx(0.12 / math.sqrt(2.0))
    unknown = Thing(thing.point_in_world, thing.point_cov_in_world, NoSize("too dark"))
    assert Obstacle.of_thing("box", unknown).radius == UNKNOWN_RADIUS


def test_target_without_a_position_takes_no_room():
    target = Target(3, TargetSource.LOCATE, "moving", "", "", 1, 5.0, 5.0, None, None, None, None)
    assert Obstacle.of_target(target) is None


def test_impossible_covariance_is_refused():
    with pytest.raises(InputError):
        Obstacle.around("it", (0.0, 0.0), -np.eye(2), 0.1)


def test_outline_is_that_of_the_body_in_the_robot_file():
    outline = BODY.outline
    assert outline.front == pytest.approx(0.084)
    assert outline.rear == pytest.approx(0.145)
    assert outline.half_width == pytest.approx(0.0995, abs=0.004)


def test_outline_of_the_robot_file_counts_where_it_is_given():
    corners = ((0.3, 0.1), (0.3, -0.1), (-0.2, 0.1), (-0.2, -0.1))
    base = ROBOT.base.model_copy(update={"outline": corners})
    outline = Outline.of(ROBOT.model_copy(update={"base": base}))
    assert (outline.front, outline.rear, outline.half_width) == (0.3, 0.2, 0.1)


def test_robot_file_without_a_body_is_given_room():
    bare: RobotDescription = ROBOT.model_copy(update={"body": ()})
    outline = Outline.of(bare)
    assert outline.front >= 0.1
    assert outline.rear >= 0.15


@settings(max_examples=40)
@given(poses, st.floats(-1.0, 1.0), st.floats(0.0, 1.0))
def test_advance_sweeps_all_that_the_outline_covers(pose, distance, share):
    swept = BODY.outline.swept_by_advance(pose, distance)
    on_the_way = BODY.outline.at(pose.after(PlanarStep(0.0, share * distance)))
    for corner in on_the_way:
        point = Surroundings.of([Obstacle("it", corner, corner, 0.0, 0.0)])
        assert point.clearances(swept)[0] <= 1e-9


@settings(max_examples=40, deadline=None)
@given(poses, st.floats(-3.1, 3.1), st.floats(0.0, 1.0), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_turn_is_never_clearer_than_any_heading_on_it(pose, turn, share, x, y):
    things = Surroundings.of([obstacle_at("it", x, y, 0.02, 0.0)])
    on_the_way = BODY.outline.at(pose.after(PlanarStep(share * turn, 0.0)))
    found = BODY.outline.turn_clearances(pose, turn, things)[0]
    assert found <= things.clearances(on_the_way)[0] + 1e-9
