"""The fake picture shows the boxes where the camera model says they are."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from tapreach.drivers.fake_picture import BOXES, FakePicture
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import load_robot

CAMERA = load_robot(Path(__file__).resolve().parents[2] / "robots" / "fake.toml").camera


@pytest.mark.parametrize(
    "pose", [PlanarPose(), PlanarPose(0.2, 0.0, 0.1), PlanarPose(0.1, -0.1, -0.1), PlanarPose(0.3, 0.2, -0.2)]
)
def test_middle_of_the_red_box_is_red(pose):
    box = BOXES[0]
    point_in_world = [box.x, box.y, box.height / 2]
    camera_from_world = (pose.to_rigid() * CAMERA.mount.base_from_camera()).inv()
    projection = CAMERA.model().project([camera_from_world.apply(point_in_world)])
    assert projection.is_inside[0]
    u, v = np.rint(projection.pixels[0]).astype(int)
    jpeg = FakePicture(CAMERA).jpeg(pose, "1")
    blue, green, red = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)[v, u].astype(int)
    assert red > 100
    assert max(blue, green) < 0.5 * red


def test_picture_changes_as_the_robot_moves():
    picture = FakePicture(CAMERA)
    assert picture.jpeg(PlanarPose(), "1") != picture.jpeg(PlanarPose(0.01, 0.0, 0.0), "1")
