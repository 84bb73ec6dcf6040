"""Sightings that slid are measured again where the tapped patch is; what cannot be told is not confirmed."""

from dataclasses import replace
from functools import lru_cache

import cv2
import numpy as np
import pytest

from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.rotation_from_background import rotation_from_background
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.depth_geometry import DepthGeometry
from tapreach.tasks.depth_views import DepthViews
from tapreach.tasks.estimating import estimate
from tapreach.tasks.following import TrackUnknown, check, close_track, follow, open_track
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import SeenWay, Sighting
from tapreach.tasks.straightening import straightened
from tapreach.tasks.target_watch import Shot
from tasks.rig import sim_description
from vision.synthetic import photographed, texture

POSES = [PlanarPose(), *(PlanarPose(0.02 * n, 0.01 * n, -0.06 * n) for n in range(1, 7))]
PLACE = Pixel(330.0, 250.0)
DEPTH, BEHIND = 0.9, 2.2
WIDTH = 0.05


def well_mounted():
    """The simulated robot with a camera that is known to stand where it should."""
    robot = sim_description()
    mount = robot.camera.mount.model_copy(update={"position_sigma": 0.001, "angle_sigma_deg": 0.05})
    return robot.model_copy(update={"camera": robot.camera.model_copy(update={"mount": mount})})


ROBOT = well_mounted()
CAMERA, MOUNT = ROBOT.camera.model(), ROBOT.camera.mount.base_from_camera()


def in_first(pose):
    """first_from_camera of a base pose."""
    return (POSES[0].to_rigid() * MOUNT).inv() * (pose.to_rigid() * MOUNT)


def pixel_of(depth, pose):
    """Where the tapped place is seen from a pose if it lies so deep."""
    (ray,) = CAMERA.unproject([[PLACE.u, PLACE.v]])
    point = in_first(pose).inv().apply(ray / ray[2] * depth)
    return Pixel(*map(float, CAMERA.project(point[None]).pixels[0]))


@lru_cache(maxsize=1)
def rays():
    v, u = np.mgrid[:480, :640]
    return CAMERA.unproject(np.stack([u.ravel(), v.ravel()], axis=1))


def on_plane(pose, depth):
    """Where on the first picture each pixel's ray meets the plane there, (2, 480, 640), and how far beside
    the tapped place [m].
    """
    step = in_first(pose)
    directions = step.rotation.apply(rays())
    points = step.translation + directions * ((depth - step.translation[2]) / directions[:, 2])[:, None]
    pixels = CAMERA.project(points).pixels.astype(np.float32)
    (ray,) = CAMERA.unproject([[PLACE.u, PLACE.v]])
    beside = np.abs(points - ray / ray[2] * depth).max(axis=1)
    return pixels.T.reshape(2, 480, 640), beside.reshape(480, 640)


def pictured(pose, front, behind, seed):
    """A small square at DEPTH before a wall, as seen from a pose."""
    near, beside = on_plane(pose, DEPTH)
    far, _ = on_plane(pose, BEHIND)
    picture = cv2.remap(behind, far[0], far[1], cv2.INTER_LINEAR)
    square = cv2.remap(front, near[0], near[1], cv2.INTER_LINEAR)
    return photographed(np.where(beside < WIDTH, square, picture), np.random.default_rng(seed))


@lru_cache(maxsize=2)
def pictures(is_plain=False):
    front = np.full((480, 640), 90.0, np.float32) if is_plain else texture(21)[:480, :640]
    behind = np.full((480, 640), 90.0, np.float32) if is_plain else texture(22)[:480, :640]
    return [pictured(pose, front, behind, seed) for seed, pose in enumerate(POSES)]


@lru_cache(maxsize=len(POSES))
def way_to(number):
    """What the background says of the way from the tapped frame: that the wheels are right."""
    return None if number == 0 else way_between(0, POSES[0], POSES[number])


def way_between(since, start, pose):
    rng = np.random.default_rng(since)
    points = rng.uniform([0.6, -1.5, 0.0], [4.0, 2.5, 1.5], (600, 3))
    before, now = (CAMERA.project((at.to_rigid() * MOUNT).inv().apply(points)) for at in (start, pose))
    both = before.is_inside & now.is_inside
    step = camera_step(start.between(pose), odometry_noise(ROBOT), MOUNT, mount_noise(ROBOT))
    seen = now.pixels[both] + 0.2 * rng.normal(size=(both.sum(), 2))
    return SeenWay(since, rotation_from_background(before.pixels[both], seen, CAMERA, step).knowledge)


def sighting(number, depth):
    pose = POSES[number]
    return Sighting(number, number, pixel_of(depth, pose), 0.3, 1.0, pose, way_to(number), number == 0)


def kept(depths, is_plain=False):
    """Views of a tracker that followed the place as if it lay at these depths; None where it was lost."""
    shown = pictures(is_plain)
    views = DepthViews(shown[0], sighting(0, DEPTH), ROBOT)
    for number, depth in enumerate(depths, start=1):
        views.keep(sighting(number, depth or DEPTH), shown[number], 0.0, depth is not None, is_stop=True)
    return views


def off(each):
    true = pixel_of(DEPTH, each.world_from_base)
    return float(np.hypot(each.pixel.u - true.u, each.pixel.v - true.v))


def test_sightings_that_are_right_stay_as_they_are():
    checked = kept([DEPTH] * 6).check()
    assert checked.layer is not None and checked.doubt == ""
    assert [each.frame_id for each in checked.sightings] == list(range(7))
    assert max(off(each) for each in checked.sightings) < 0.3


def test_sightings_that_slid_to_what_is_behind_are_measured_again():
    slid = [sighting(0, DEPTH), *(sighting(number, BEHIND) for number in range(1, 7))]
    assert max(off(each) for each in slid) > 4.0
    before = estimate(slid, ROBOT, False)
    checked = kept([BEHIND] * 6).check()
    assert checked.layer is not None and checked.doubt == ""
    assert len(checked.sightings) >= 5
    assert max(off(each) for each in checked.sightings) < 0.5
    (ray,) = CAMERA.unproject([[PLACE.u, PLACE.v]])
    true = DEPTH * float(np.linalg.norm(ray / ray[2]))
    after = estimate(checked.sightings, ROBOT, False)
    assert before.range_interval_95 is not None and before.range_interval_95[0] > true
    assert after.range_interval_95 is not None
    assert after.range_interval_95[0] < true < after.range_interval_95[1]


def test_place_that_was_lost_is_found_again_in_the_newest_picture():
    checked = kept([DEPTH, DEPTH, None, None, None, None]).check()
    assert checked.layer is not None and checked.doubt == ""
    assert checked.newest is not None
    assert checked.sightings[-1].frame_id == 6
    assert off(checked.sightings[-1]) < 0.5


def test_plain_place_is_not_confirmed_and_counts_for_less():
    checked = kept([DEPTH] * 6, is_plain=True).check()
    assert "several distances" in checked.doubt
    assert checked.newest is None and checked.layer is None
    assert checked.sightings[0].sigma == 0.3
    assert {each.sigma for each in checked.sightings[1:]} == {0.6}
    assert max(off(each) for each in checked.sightings) < 0.3


def test_views_from_one_place_confirm_nothing_and_change_nothing():
    views = DepthViews(pictures()[0], sighting(0, DEPTH), ROBOT)
    again = replace(sighting(0, DEPTH), frame_id=1, is_key=False)
    views.keep(again, pictures()[0], 0.0, is_seen=True, is_stop=True)
    checked = views.check()
    assert checked.layer is None and checked.doubt == ""
    assert [each.sigma for each in checked.sightings] == [0.3, 0.3]


def test_no_more_than_twenty_frames_are_kept_and_the_ends_stay():
    views = DepthViews(pictures()[0], sighting(0, DEPTH), ROBOT)
    for number in range(1, 41):
        pose = PlanarPose(0.01 * number)
        there = Sighting(number, number, PLACE, 0.3, 1.0, pose)
        views.keep(there, pictures()[0], 0.0, is_seen=True, is_stop=True)
    kept_ids = [each.frame_id for each in views.check().sightings]
    assert len(kept_ids) <= 20
    assert kept_ids[0] == 0
    assert views.newest.frame_id == 40


def test_warps_and_their_covariance_are_those_of_the_cameras():
    straight = straightened([replace(sighting(number, DEPTH), way=None) for number in range(7)], ROBOT)
    geometry = DepthGeometry(straight, ROBOT, PLACE, 8, 1.0)
    (warp,) = geometry.warps(4, np.array([1.0 / DEPTH]))
    pixel = pixel_of(DEPTH, POSES[4])
    assert warp[:, 2] == pytest.approx([pixel.u, pixel.v], abs=1e-6)
    assert float(np.linalg.det(geometry.warps(0, np.array([1.0]))[0][:, :2])) == pytest.approx(1.0, abs=1e-3)
    near, far = (np.linalg.eigvalsh(geometry.covariance(number, 1.0 / DEPTH))[1] for number in (1, 6))
    assert 0.0 < near < far


def test_watch_goes_on_from_where_the_check_found_the_place():
    shown = pictures()
    jpegs = [bytes(cv2.imencode(".jpg", each)[1]) for each in shown]
    shots = [Shot(n, n, jpeg, POSES[n], 0.0) for n, jpeg in enumerate(jpegs)]
    black = bytes(cv2.imencode(".jpg", np.zeros((480, 640), np.uint8))[1])
    open_track(77, shots[0], PLACE, ROBOT, uses_background=False)
    try:
        for number in range(1, 6):
            follow(77, shots[number], is_stop=True)
        assert follow(77, replace(shots[5], frame_id=15, jpeg=black)).sighting is None
        follow(77, shots[6], is_stop=True)
        checked = check(77)
        assert checked.sightings[-1].frame_id == 6
        assert off(checked.sightings[-1]) < 0.5
        after = follow(77, replace(shots[6], frame_id=16))
        assert after.sighting is not None and off(after.sighting) < 0.5
    finally:
        close_track(77)
    with pytest.raises(TrackUnknown):
        check(77)


def test_place_that_grew_past_comparing_stays_as_it_was_followed():
    """Near views that the tapped patch cannot be fitted to any more count for less; they do not go."""
    views = kept([DEPTH] * 6)
    near = PlanarPose(0.45, 0.0, -0.1)
    blurred = cv2.GaussianBlur(
        pictured(near, *(texture(each)[:480, :640] for each in (21, 22)), 9), (0, 0), 9.0
    )
    there = replace(
        sighting(6, DEPTH), frame_id=9, pixel=pixel_of(DEPTH, near), world_from_base=near, way=None
    )
    views.keep(there, blurred, 0.0, is_seen=True, is_stop=True)
    assert views.check().sightings[-1] == replace(there, sigma=0.6)
    assert views.check().sightings[-1] == replace(there, sigma=0.6)


def test_later_pictures_are_compared_with_one_seen_from_nearer():
    """The tapped picture shows too little; a slide later on is told by a sharper one taken on the way."""
    front, behind = (texture(seed)[:480, :640] for seed in (21, 22))
    views = DepthViews(cv2.GaussianBlur(pictures()[0], (0, 0), 3.0), sighting(0, DEPTH), ROBOT)
    for number in range(1, 7):
        views.keep(sighting(number, DEPTH), pictures()[number], 0.0, is_seen=True, is_stop=True)
    drive = {number: PlanarPose(0.035 * (number - 6), 0.06, -0.2) for number in range(7, 20)}
    for number, pose in drive.items():
        true, has_slid = pixel_of(DEPTH, pose), number > 15
        place = Pixel(true.u + 9.0, true.v - 6.0) if has_slid else true
        way = way_between(15, drive[15], pose) if has_slid else way_between(0, POSES[0], pose)
        there = Sighting(number, number, place, 0.3, 1.0, pose, way, is_key=number == 15)
        views.keep(there, pictured(pose, front, behind, number), 0.0, is_seen=True, is_stop=True)
        if number in (15, 19):
            checked = views.check()
            assert checked.layer is not None
    assert [each.frame_id for each in checked.sightings] == list(range(20))
    assert max(off(each) for each in checked.sightings) < 0.5  # the tapped picture alone: 1.0
