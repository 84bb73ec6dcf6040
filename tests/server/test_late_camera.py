"""Pictures of a late camera: the server places them where the robot was when they were taken."""

from pathlib import Path

import pytest

from server.conftest import InlineService
from tapreach.drivers.fake import FakeRobot
from tapreach.estimation.camera_delay import CameraDelay
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS, ManualClock
from tapreach.robot.config import RobotDescription
from tapreach.server.station import Station


@pytest.fixture
def station(description: RobotDescription, tmp_path: Path) -> Station:
    clock = ManualClock()
    made = Station(FakeRobot(description, clock), clock, tmp_path, InlineService())
    for step in range(51):
        made.poses.add(1000 * MS + 20 * MS * step, PlanarPose(0.0, 0.0, 0.015 * step))
    return made


def test_frame_is_placed_by_its_stamp_until_a_delay_is_known(station: Station) -> None:
    pose = station.pose_at(1500 * MS)
    assert pose is not None and pose.heading == pytest.approx(0.375)


def test_frame_of_a_late_camera_is_placed_where_it_was_taken(station: Station) -> None:
    station.camera_delay.known = CameraDelay(0.08, 0.002)
    pose = station.pose_at(1500 * MS)
    assert pose is not None and pose.heading == pytest.approx(0.315)
    newest = station.pose_at(2070 * MS)
    assert newest is not None and newest.heading == pytest.approx(0.7425), "taken before the newest odometry"
    assert station.pose_at(1050 * MS) is None, "taken before the oldest pose"
