"""Transforms in the right direction, and the exponential map in the order of the conventions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.geometry.pose import (
    camera_mount,
    perturbed,
    pose_exp,
    pose_from_matrix,
    pose_log,
    pose_to_matrix,
    skew,
)

small = st.floats(-1.5, 1.5)
tangents = st.tuples(small, small, small, small, small, small).map(np.array)
poses = tangents.map(pose_exp)


def assert_same_pose(first: RigidTransform, second: RigidTransform, atol: float = 1e-12) -> None:
    np.testing.assert_allclose(first.as_matrix(), second.as_matrix(), atol=atol)


@given(poses, poses, poses)
def test_poses_form_a_group(a, b, c):
    assert_same_pose((a * b) * c, a * (b * c))
    assert_same_pose(a * a.inv(), RigidTransform.identity())
    assert_same_pose((a * b).inv(), b.inv() * a.inv())


@given(tangents)
def test_log_inverts_exp(tangent):
    np.testing.assert_allclose(pose_log(pose_exp(tangent)), tangent, atol=1e-9)


def test_exp_takes_the_translation_first():
    np.testing.assert_allclose(pose_exp([1, 2, 3, 0, 0, 0]).translation, [1, 2, 3])
    np.testing.assert_allclose(
        pose_exp([0, 0, 0, 0, 0, 0.5]).apply([1, 0, 0]), [math.cos(0.5), math.sin(0.5), 0]
    )


@given(poses, tangents)
def test_perturbation_acts_in_the_body_frame(pose, tangent):
    assert_same_pose(pose.inv() * perturbed(pose, tangent), pose_exp(tangent))


def test_perturbation_of_a_turned_pose_moves_along_its_own_axes():
    facing_left = pose_exp([5, 0, 0, 0, 0, math.pi / 2])
    moved = perturbed(facing_left, [0.1, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(moved.translation - facing_left.translation, [0, 0.1, 0], atol=1e-12)


@given(poses)
def test_matrix_round_trip(pose):
    assert_same_pose(pose_from_matrix(pose_to_matrix(pose)), pose)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m.__setitem__((0, 0), 1.1), "off orthonormal"),
        (lambda m: m.__setitem__((3, 0), 0.5), "last row"),
        (lambda m: m.__setitem__((0, 3), np.nan), "nan at index"),
        (lambda m: m.__setitem__((2, 2), -1.0), "mirrors"),
    ],
)
def test_matrix_that_is_no_rigid_pose_is_refused(change, message):
    matrix = np.eye(4)
    change(matrix)
    with pytest.raises(InputError, match=message):
        pose_from_matrix(matrix)


def test_level_mount_looks_along_the_heading():
    base_from_camera = camera_mount((0.1, -0.02, 0.15))
    np.testing.assert_allclose(base_from_camera.apply([0, 0, 2]), [2.1, -0.02, 0.15], atol=1e-12)
    np.testing.assert_allclose(base_from_camera.apply([1, 0, 0]), [0.1, -1.02, 0.15], atol=1e-12)
    np.testing.assert_allclose(base_from_camera.apply([0, 1, 0]), [0.1, -0.02, -0.85], atol=1e-12)


def test_mount_angles_turn_the_way_they_are_named():
    ahead = np.array([0.0, 0.0, 1.0])
    down = camera_mount((0, 0, 0), pitch=0.2).apply(ahead)
    left = camera_mount((0, 0, 0), yaw=0.2).apply(ahead)
    np.testing.assert_allclose(down, [math.cos(0.2), 0, -math.sin(0.2)], atol=1e-12)
    np.testing.assert_allclose(left, [math.cos(0.2), math.sin(0.2), 0], atol=1e-12)
    right_side = camera_mount((0, 0, 0), roll=0.2).apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(right_side, [0, -math.cos(0.2), -math.sin(0.2)], atol=1e-12)


def test_yawed_and_pitched_mount_keeps_the_picture_upright():
    picture_right = camera_mount((0, 0, 0), pitch=0.3, yaw=0.4).rotation.apply([1.0, 0.0, 0.0])
    assert picture_right[2] == pytest.approx(0.0, abs=1e-12)


@given(tangents, tangents)
def test_skew_is_the_cross_product(a, b):
    np.testing.assert_allclose(skew(a[:3]) @ b[:3], np.cross(a[:3], b[:3]), atol=1e-12)
