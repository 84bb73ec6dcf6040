"""The bench's own simulation, in plain numpy, against the package's geometry."""

import math

import numpy as np
import pytest

from tapreach.bench.accuracy_scene import (
    CAMERA,
    LEVER,
    PITCH,
    is_in_picture,
    onto_picture,
    points_in_cameras,
    poses_after,
    project,
    target_at,
)
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount

TURNS = np.array([[0.2, -0.1, 0.0], [0.0, 0.3, 0.05]])
ADVANCES = np.array([[0.1, 0.2, -0.05], [0.3, 0.0, 0.1]])
TARGETS = np.array([[1.5, 0.1, 0.2], [2.0, -0.2, 0.0]])


def test_poses_are_those_of_turning_and_advancing():
    for turns, advances, poses in zip(TURNS, ADVANCES, poses_after(TURNS, ADVANCES), strict=True):
        pose = PlanarPose()
        for turn, advance, expected in zip(turns, advances, poses[1:], strict=True):
            pose = pose.after(PlanarStep(turn, advance))
            np.testing.assert_allclose([pose.x, pose.y, pose.heading], expected, atol=1e-12)


@pytest.mark.parametrize("lever", [LEVER, np.array([0.0, 0.0, 0.15])])
def test_pixels_are_those_of_the_camera_on_its_mount(lever):
    poses = poses_after(TURNS, ADVANCES)
    pixels = project(points_in_cameras(poses, TARGETS, lever))
    for trial, target in enumerate(TARGETS):
        for view, pose in enumerate(poses[trial]):
            world_from_camera = PlanarPose(*pose).to_rigid() * camera_mount(lever, PITCH)
            seen = CAMERA.project(world_from_camera.inv().apply(target)[None])
            assert seen.is_valid[0]
            np.testing.assert_allclose(pixels[trial, view], seen.pixels[0], atol=1e-9)


def test_target_lies_at_its_bearing_and_depth():
    bearings, depths = np.array([[0.1, -0.2], [0.0, 0.3]]), np.array([0.5, 5.0])
    points = points_in_cameras(np.zeros((2, 1, 3)), target_at(bearings, depths))[:, 0]
    np.testing.assert_allclose(points[:, 2], depths)
    np.testing.assert_allclose(points[:, :2] / points[:, 2:], bearings, atol=1e-12)


def test_nothing_behind_the_camera_is_in_the_picture():
    pixels = project(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [10.0, 0.0, 1.0], [math.nan, 0.0, 1.0]]))
    assert is_in_picture(pixels).tolist() == [False, True, False, False]


def test_tap_beyond_the_border_lands_on_it():
    moved = onto_picture(np.array([[-9.0, 100.0], [700.0, 500.0]]))
    np.testing.assert_array_equal(moved, [[-0.5, 100.0], [639.5, 479.5]])
    assert is_in_picture(moved).all()
