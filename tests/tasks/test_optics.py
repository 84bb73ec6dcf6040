"""Points of the world as the robot's camera sees them."""

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.optics import optics_of, points_in_camera
from tasks.rig import sim_description


def test_points_are_seen_as_the_transforms_say() -> None:
    camera = sim_description().camera
    points, pose = np.array([[1.0, 0.3, 0.1], [0.2, -2.0, 0.7]]), PlanarPose(0.4, -0.2, 0.8)
    kept = points.copy()
    expected = (pose.to_rigid() * camera.mount.base_from_camera()).inv().apply(points)
    np.testing.assert_allclose(points_in_camera(points, pose, camera), expected, atol=1e-12)
    np.testing.assert_array_equal(points, kept)


def test_optics_of_a_camera_are_made_once() -> None:
    camera = sim_description().camera
    assert optics_of(camera)[0] is optics_of(camera.model_copy())[0]
