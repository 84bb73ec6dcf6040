"""What the background says of the way goes into the estimate; where it says nothing, that is said."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.estimating import HeadingSource, estimate
from tapreach.tasks.sighting import SeenWay, Sighting, is_apart, ray_of, rays_of
from tapreach.tasks.straightening import straightened
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap
from tasks.rig import sim_description
from tasks.seen_ways import pixels_of, seen_way

ROBOT = sim_description()
SAID = [PlanarPose()]
for step in (PlanarStep(0.2, 0.0), PlanarStep(0.0, 0.15), PlanarStep(0.0, 0.15)):
    SAID.append(SAID[-1].after(step))
DRIFT = math.radians(0.6)
TARGET = np.array([1.4, 0.65, 0.1])


def true_poses():
    """Wheels that hid a drift to the left on the straight."""
    poses = SAID[:2]
    for _ in range(2):
        poses = [*poses, poses[-1].after_arc(0.15, DRIFT / 2.0)]
    return poses


def way(true, first, second):
    return seen_way((SAID[first], true[first]), (SAID[second], true[second]), first)


def sightings(true, ways):
    found = []
    for index, (said, pose) in enumerate(zip(SAID, true, strict=True)):
        (u, v) = map(float, pixels_of(TARGET[None], pose).pixels[0])
        found.append(Sighting(index, index, Pixel(u, v), 0.4, 1.0, said, ways.get(index), True))
    return found


def with_background():
    true = true_poses()
    return sightings(true, {index: way(true, index - 1, index) for index in (1, 2, 3)})


def test_drift_that_the_wheels_hid_is_taken_out_and_the_newest_pose_stays():
    straight = straightened(with_background(), ROBOT)
    assert straight.reason == ""
    poses = [sighting.world_from_base for sighting in straight.sightings]
    assert is_apart(poses[-1], SAID[-1], 1e-9, 1e-9) is False
    assert poses[-1].heading - poses[1].heading == pytest.approx(DRIFT, abs=math.radians(0.2))


def test_target_is_where_it_is_from_the_present_base():
    found = estimate(with_background(), ROBOT, False)
    assert found.heading_from is HeadingSource.BACKGROUND
    assert found.point_in_world is not None
    in_base = SAID[-1].to_rigid().inv().apply(found.point_in_world)
    truth = true_poses()[-1].to_rigid().inv().apply(TARGET)
    assert np.linalg.norm(in_base - truth) < 0.03 * np.linalg.norm(truth)
    by_wheels = estimate([replace(each, way=None) for each in with_background()], ROBOT, False)
    assert by_wheels.point_in_base is not None and found.point_in_base is not None
    wheels_off = np.linalg.norm(by_wheels.point_in_base - truth)
    assert wheels_off > 3.0 * np.linalg.norm(found.point_in_base - truth)


@pytest.mark.parametrize(
    ("way", "words"),
    [(SeenWay(1, NOTHING_SEEN, "the picture has little texture"), "little texture"), (None, "not looked at")],
)
def test_fall_back_on_the_wheels_is_said_and_why(way, words):
    seen = sightings(SAID, {3: way})
    found = estimate(seen, ROBOT, False)
    assert found.heading_from is HeadingSource.WHEELS
    assert words in found.heading_reason
    report = TargetReport(1, TargetSource.LOCATE, Tap(0, 320.0, 240.0), ROBOT)
    target = report.target(seen, found, True)
    assert target.point_in_world is not None
    assert "turns by the wheels alone" in target.reason and words in target.reason


def test_lines_of_sight_pass_through_what_was_seen():
    seen = sightings(SAID, {})
    for ray in rays_of(seen, ROBOT):
        along = float((TARGET - ray.origin) @ ray.direction)
        assert ray.at(along) == pytest.approx(TARGET, abs=1e-6)
    assert ray_of(seen[2], ROBOT).origin == pytest.approx(rays_of(seen, ROBOT)[2].origin)
    assert rays_of([], ROBOT) == ()


def test_poses_are_apart_by_way_or_by_turn_across_the_half_circle():
    assert is_apart(PlanarPose(), PlanarPose(0.03), 0.02, 1.0)
    assert is_apart(PlanarPose(), PlanarPose(heading=0.2), 1.0, 0.1)
    assert not is_apart(PlanarPose(heading=3.13), PlanarPose(heading=-3.13), 1.0, 0.1)


def test_slip_that_only_the_longest_way_shows_is_not_believed():
    seen = with_background()
    sound, last = seen[2].way, seen[3].way
    assert sound is not None and last is not None
    seen[2] = replace(seen[2], way=replace(sound, since_id=1))
    wrong = replace(last.knowledge, vector=40.0 * last.knowledge.vector + 1e5, has_slipped=True)
    alone = [*seen[:3], replace(seen[3], way=SeenWay(1, wrong))]
    trusted = [*seen[:3], replace(seen[3], way=None)]
    ways = [
        straightened(each, ROBOT).sightings[1].world_from_base.between(SAID[-1]) for each in (alone, trusted)
    ]
    assert not is_apart(ways[0], ways[1], 0.005, math.radians(0.3))
    of_heading = [
        np.linalg.norm(straightened(each, ROBOT).errors.by_base[-1, 5]) for each in (alone, trusted)
    ]
    assert of_heading[0] > 10.0 * of_heading[1]


def test_views_that_break_off_from_the_others_widen_the_way_instead_of_the_truth():
    """Wheels that turn against an obstacle: the last 24 cm were 2.4 cm."""
    said = [PlanarPose()]
    for step in [PlanarStep(0.3, 0.0)] + [PlanarStep(0.0, 0.08)] * 6:
        said.append(said[-1].after(step))
    true = [*said[:5], *(said[4].after(PlanarStep(0.0, 0.008 * i)) for i in (1, 2, 3))]
    seen = []
    for index, (pose, at) in enumerate(zip(said, true, strict=True)):
        (u, v) = map(float, pixels_of(TARGET[None], at).pixels[0])
        seen.append(Sighting(index, index, Pixel(u, v), 0.4, 1.0, pose))
    found = estimate(seen, ROBOT, False)
    in_base = true[-1].to_rigid().inv().apply(TARGET)
    assert found.point_in_base is not None and found.point_cov_in_base is not None
    error = found.point_in_base - in_base
    assert error @ np.linalg.solve(found.point_cov_in_base, error) < 16.0
    assert 0 not in found.rejected_views
