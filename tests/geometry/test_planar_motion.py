"""Group axioms of floor poses, arcs against small steps, and agreement with poses in space."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped

numbers = st.floats(-3.0, 3.0)
poses = st.builds(PlanarPose, numbers, numbers, numbers)
steps = st.builds(PlanarStep, numbers, numbers)


def assert_same(first: PlanarPose, second: PlanarPose, atol: float = 1e-12) -> None:
    np.testing.assert_allclose(
        (first.x, first.y, first.heading), (second.x, second.y, second.heading), atol=atol
    )


@given(poses, poses, poses)
def test_planar_poses_form_a_group(a, b, c):
    assert_same(a.compose(b).compose(c), a.compose(b.compose(c)))
    assert_same(a.compose(a.inverse()), PlanarPose())
    assert_same(a.inverse().compose(a), PlanarPose())


@given(poses, poses)
def test_between_leads_from_one_to_the_other(a, b):
    assert_same(a.compose(a.between(b)), b)


def test_between_is_seen_from_the_first_pose():
    facing_left = PlanarPose(1.0, 2.0, math.pi / 2)
    assert_same(facing_left.between(PlanarPose(0.0, 4.0, math.pi)), PlanarPose(2.0, 1.0, math.pi / 2))


@given(poses, poses)
def test_planar_and_spatial_composition_agree(a, b):
    np.testing.assert_allclose(
        a.compose(b).to_rigid().as_matrix(), (a.to_rigid() * b.to_rigid()).as_matrix(), atol=1e-12
    )


@given(poses)
def test_from_rigid_inverts_to_rigid_up_to_full_turns(pose):
    back = PlanarPose.from_rigid(pose.to_rigid())
    assert_same(back, PlanarPose(pose.x, pose.y, wrapped(pose.heading)), atol=1e-9)


@given(poses, st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))
def test_arc_equals_many_short_arcs(start, distance, turn):
    whole = start.after_arc(distance, turn)
    parts = start
    for _ in range(50):
        parts = parts.after_arc(distance / 50, turn / 50)
    assert_same(whole, parts, atol=1e-10)


def test_quarter_arc_ends_on_the_circle():
    radius = 0.5
    end = PlanarPose().after_arc(radius * math.pi / 2, math.pi / 2)
    assert_same(end, PlanarPose(radius, radius, math.pi / 2))


def test_step_turns_before_it_advances():
    end = PlanarPose(1.0, 0.0, math.pi / 2).after(PlanarStep(math.pi / 2, 0.2))
    assert_same(end, PlanarPose(0.8, 0.0, math.pi))


@given(poses, steps)
def test_step_equals_a_turn_and_a_straight_arc(start, step):
    assert_same(start.after(step), start.after_arc(0.0, step.turn).after_arc(step.advance, 0.0))


def test_pose_that_is_not_a_number_is_refused():
    with pytest.raises(InputError, match="heading is nan"):
        PlanarPose(0.0, 0.0, float("nan"))


@given(st.floats(-50.0, 50.0))
def test_wrapped_angle_points_the_same_way(angle):
    assert -math.pi < wrapped(angle) <= math.pi
    assert math.cos(wrapped(angle)) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped(angle)) == pytest.approx(math.sin(angle), abs=1e-9)
