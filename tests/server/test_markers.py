"""Targets in the picture: where the camera model says, with a region that grows with the uncertainty."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tapreach.estimation.box_extent import BoxExtent
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import load_robot
from tapreach.server.markers import Mark, MarkerProjection
from tapreach.server.views import target_view
from tapreach.tasks.extent import Extent
from tapreach.tasks.target import Target, TargetSource

CAMERA = load_robot(Path(__file__).resolve().parents[2] / "robots" / "fake.toml").camera
HERE = PlanarPose(0.3, -0.2, 0.4)


def target(point, sigma: float = 0.02, target_id: int = 7) -> Target:
    cov = np.diag([sigma, 2 * sigma, sigma / 2]) ** 2
    place = None if point is None else np.array(point)
    return Target(
        target_id, TargetSource.LOCATE, "determined", "", "", 3, 1.0, 2.0, place, cov, 1.0, (0.9, np.inf)
    )


def ahead(distance: float) -> list[float]:
    """A point on the floor straight ahead of the base at HERE."""
    return [*HERE.to_rigid().apply([distance, 0.0, 0.0])]


def markers(*targets: Target, pose: PlanarPose = HERE) -> list[dict]:
    marks = [mark for each in targets if (mark := Mark.of(each))]
    meta = json.loads(MarkerProjection(CAMERA).meta(pose, marks))
    assert meta["base"] == [pose.x, pose.y, pose.heading]
    return meta["markers"]


def test_marker_falls_where_the_camera_sees_the_point():
    (marker,) = markers(target(ahead(1.0)))
    camera_from_world = (HERE.to_rigid() * CAMERA.mount.base_from_camera()).inv()
    expected = CAMERA.model().project([camera_from_world.apply(ahead(1.0))]).pixels[0]
    assert (marker["u"], marker["v"]) == pytest.approx(tuple(expected), abs=0.01)
    assert marker["inside"]


def test_region_surrounds_the_marker_and_grows_with_the_uncertainty():
    small, large = (markers(target(ahead(1.0), sigma))[0] for sigma in (0.01, 0.03))
    for marker in (small, large):
        u, v = np.array(marker["region"]).T
        assert u.min() < marker["u"] < u.max()
        assert v.min() < marker["v"] < v.max()
    assert np.ptp(np.array(large["region"])[:, 0]) > 2 * np.ptp(np.array(small["region"])[:, 0])


def test_several_targets_keep_their_own_places():
    near, far = markers(target(ahead(0.6), target_id=1), target(ahead(2.0), target_id=2))
    assert (near["target_id"], far["target_id"]) == (1, 2)
    assert near["v"] > far["v"]
    assert near["u"] == pytest.approx(far["u"], abs=0.1)


def test_target_behind_the_camera_or_without_a_place_is_not_drawn():
    assert markers(target(ahead(-1.0)), target(None)) == []


def test_frame_of_unknown_pose_has_no_markers():
    marks = [Mark.of(target(ahead(1.0)))]
    assert json.loads(MarkerProjection(CAMERA).meta(None, marks)) == {"base": None, "markers": []}


def test_view_of_a_target_is_seen_from_the_base():
    view = target_view(target(ahead(1.0)), HERE)
    assert view.point_in_base == pytest.approx((1.0, 0.0, 0.0))
    assert view.point_in_world == pytest.approx(tuple(ahead(1.0)))
    rotation = np.array([[np.cos(0.4), np.sin(0.4)], [-np.sin(0.4), np.cos(0.4)]])
    cov = rotation @ np.diag([0.02, 0.04]) ** 2 @ rotation.T
    assert view.sigma == pytest.approx((*np.sqrt(np.diag(cov)), 0.01))
    assert (view.range_low, view.range_high) == (0.9, None)


def test_outline_on_the_floor_holds_95_percent():
    given = target(ahead(1.0))
    outline = np.array(target_view(given, HERE).region_in_world) - given.point_in_world[:2]
    inverse = np.linalg.inv(given.point_cov_in_world[:2, :2])
    assert np.einsum("ni,ij,nj->n", outline, inverse, outline) == pytest.approx(np.full(32, 5.991), abs=0.01)


def sized(point) -> Target:
    offsets = np.array([[0.0, 0.1, 0.2], [0.0, -0.1, 0.2], [0.0, -0.1, 0.0], [0.0, 0.1, 0.0]])
    corners = np.array(point) + offsets
    size = BoxExtent(0.2, 0.2, 0.01, 0.02, corners)
    return replace(target(point), extent=Extent(size, ""))


def test_box_of_the_size_sticks_to_the_thing_wherever_the_robot_is():
    thing = sized(ahead(1.0))
    for pose in (HERE, PlanarPose(0.5, -0.1, 0.35)):
        (marker,) = markers(thing, pose=pose)
        camera_from_world = (pose.to_rigid() * CAMERA.mount.base_from_camera()).inv()
        expected = CAMERA.model().project(camera_from_world.apply(thing.extent.size.corners_in_world)).pixels
        assert np.array(marker["box"]) == pytest.approx(expected, abs=0.06)
        assert len(marker["region"]) > 8


def test_target_without_a_size_has_no_box_and_says_so():
    assert markers(target(ahead(1.0)))[0]["box"] == []
    assert target_view(target(ahead(1.0)), HERE).extent is None


def test_size_is_told_with_its_sigmas_and_no_size_with_its_reason():
    told = target_view(sized(ahead(1.0)), HERE).extent
    assert (told.width, told.height_sigma, told.reason) == (0.2, 0.02, "")
    none = replace(target(ahead(1.0)), extent=Extent(None, "straight below"))
    told = target_view(none, HERE).extent
    assert (told.width, told.width_sigma, told.reason) == (None, None, "straight below")
