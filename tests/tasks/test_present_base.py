"""What the way since the last sighting makes of a located point."""

import math

import numpy as np
import pytest

from tapreach.estimation.odometry_noise import pose_errors
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.present_base import at_present
from tapreach.tasks.robot_noise import odometry_noise
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap
from tasks.rig import sim_description

ROBOT = sim_description()
TARGET = np.array([1.4, 0.2, 0.1])
ROLLED_ON = PlanarPose(0.4, 0.05, 0.1).after(PlanarStep(0.0, 0.25))


def located() -> LocatedPoint:
    seen = []
    for index, pose in enumerate([PlanarPose(), PlanarPose(0.2, 0.1, 0.15), PlanarPose(0.4, 0.05, 0.1)]):
        in_camera = points_in_camera(TARGET[None], pose, ROBOT.camera)
        u, v = map(float, optics_of(ROBOT.camera)[0].project(in_camera).pixels[0])
        seen.append(Sighting(index, index, Pixel(u, v), 0.4, 1.0, pose))
    return estimate(seen, ROBOT, False)


def test_nothing_is_added_where_the_base_still_stands() -> None:
    found = located()
    present = at_present(found, found.sightings[-1].world_from_base, ROBOT)
    assert present is not None and found.point_cov_in_world is not None
    np.testing.assert_allclose(present.cov_in_world, found.point_cov_in_world, atol=1e-12)


def test_way_since_widens_the_region_by_what_the_wheels_may_do_wrong() -> None:
    """Against a thousand true ways: the point in the true base, put down where the wheels say it is."""
    found = located()
    present = at_present(found, ROLLED_ON, ROBOT)
    assert present is not None and found.point_in_world is not None
    errors = pose_errors([found.sightings[-1].world_from_base, ROLLED_ON], odometry_noise(ROBOT))[1]
    rng = np.random.default_rng(5)
    moved = []
    for normals in rng.normal(size=(2000, errors.shape[1])):
        truth = ROLLED_ON.compose(PlanarPose(*map(float, errors @ normals))).to_rigid()
        moved.append(ROLLED_ON.to_rigid().apply(truth.inv().apply(found.point_in_world)))
    drawn = np.cov(np.array(moved).T)
    np.testing.assert_allclose(present.by_way[:2, :2], drawn[:2, :2], rtol=0.15, atol=2e-6)
    assert present.by_way[2, 2] == 0.0


def test_target_lost_on_the_way_is_shown_with_the_way_in_its_region_and_interval() -> None:
    found = located()
    report = TargetReport(1, TargetSource.LOCATE, Tap(0, 320.0, 240.0), ROBOT)
    at_loss = report.target(found.sightings, found, False)
    now = report.target(found.sightings, found, False, here=ROLLED_ON)
    assert at_loss.point_cov_in_world is not None and now.point_cov_in_world is not None
    assert np.linalg.eigvalsh(now.point_cov_in_world - at_loss.point_cov_in_world)[-1] > 0.0
    assert np.linalg.det(now.point_cov_in_world) > np.linalg.det(at_loss.point_cov_in_world)
    assert now.range is not None and now.range_interval is not None
    assert now.point_in_world is not None and at_loss.range_interval is not None
    ways = now.point_in_world[:2] - (ROLLED_ON.x, ROLLED_ON.y)
    assert now.range == pytest.approx(math.hypot(*ways))
    low, high = now.range_interval
    assert high - low > at_loss.range_interval[1] - at_loss.range_interval[0]
