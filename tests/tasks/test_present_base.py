"""What the way since the last sighting makes of a located point."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.estimation.odometry_noise import pose_errors
from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.present_base import at_present
from tapreach.tasks.robot_noise import odometry_noise
from tapreach.tasks.sighting import Passed, SeenWay, Sighting
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap
from tasks.rig import sim_description
from tasks.seen_ways import seen_way

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


def test_way_that_the_wheels_hid_is_taken_out_by_what_the_background_showed() -> None:
    """Bumped into something unseen: turned by 6° that no wheel knows of."""
    found, first = located(), PlanarPose(0.4, 0.05, 0.1)
    truth = PlanarPose(ROLLED_ON.x, ROLLED_ON.y, ROLLED_ON.heading + math.radians(6.0))
    way = (
        replace(found.sightings[-1], is_key=True),
        Passed(7, ROLLED_ON, seen_way((first, first), (ROLLED_ON, truth), 2), False),
    )
    by_wheels, bridged = at_present(found, ROLLED_ON, ROBOT), at_present(found, ROLLED_ON, ROBOT, way)
    assert by_wheels is not None and bridged is not None and found.point_in_world is not None
    true_in_base = truth.to_rigid().inv().apply(found.point_in_world)
    off = [
        np.linalg.norm(ROLLED_ON.to_rigid().inv().apply(each.point_in_world) - true_in_base)
        for each in (by_wheels, bridged)
    ]
    assert off[0] > 0.05
    assert off[1] < 0.2 * off[0]
    error = bridged.point_in_world - ROLLED_ON.to_rigid().apply(true_in_base)
    assert error[:2] @ np.linalg.solve(bridged.by_way[:2, :2], error[:2]) < 9.2


def test_background_that_agrees_with_the_wheels_makes_the_way_surer() -> None:
    found, first = located(), PlanarPose(0.4, 0.05, 0.1)
    way = (
        replace(found.sightings[-1], is_key=True),
        Passed(7, ROLLED_ON, seen_way((first, first), (ROLLED_ON, ROLLED_ON), 2), False),
    )
    by_wheels, bridged = at_present(found, ROLLED_ON, ROBOT), at_present(found, ROLLED_ON, ROBOT, way)
    assert by_wheels is not None and bridged is not None
    across = np.array([-math.sin(ROLLED_ON.heading), math.cos(ROLLED_ON.heading), 0.0])
    assert bridged.way_sd_along(across) < 0.6 * by_wheels.way_sd_along(across)


def test_way_of_which_nothing_is_seen_is_that_of_the_wheels() -> None:
    found = located()
    way = (found.sightings[-1], Passed(7, ROLLED_ON, SeenWay(2, NOTHING_SEEN, "too dark"), True))
    by_wheels, bridged = at_present(found, ROLLED_ON, ROBOT), at_present(found, ROLLED_ON, ROBOT, way)
    assert by_wheels is not None and bridged is not None
    np.testing.assert_allclose(bridged.point_in_world, by_wheels.point_in_world, atol=1e-9)
    np.testing.assert_allclose(bridged.cov_in_world, by_wheels.cov_in_world, rtol=0.02, atol=1e-7)


def test_way_of_hundreds_of_pictures_is_that_of_the_wheels() -> None:
    """What they say of it would take longer to reckon than it is worth."""
    found, first = located(), PlanarPose(0.4, 0.05, 0.1)
    seen = seen_way((first, first), (ROLLED_ON, ROLLED_ON), 2)
    way = (
        replace(found.sightings[-1], is_key=True),
        *(Passed(7 + i, ROLLED_ON, seen, True) for i in range(300)),
    )
    by_wheels, bridged = at_present(found, ROLLED_ON, ROBOT), at_present(found, ROLLED_ON, ROBOT, way)
    assert by_wheels is not None and bridged is not None
    np.testing.assert_array_equal(bridged.cov_in_world, by_wheels.cov_in_world)
