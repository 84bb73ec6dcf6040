"""Rays, planes and the closest approach of two rays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.pose import pose_exp
from tapreach.geometry.ray import Ray, closest_approach, meet_plane

numbers = st.floats(-5.0, 5.0)
points = st.tuples(numbers, numbers, numbers).map(np.array)


@given(points, points, points)
def test_rays_towards_one_point_meet_there(first_origin, second_origin, target):
    first_way, second_way = target - first_origin, target - second_origin
    lengths = np.linalg.norm(first_way) * np.linalg.norm(second_way)
    if lengths < 0.1 or np.linalg.norm(np.cross(first_way, second_way)) < 0.05 * lengths:
        return
    meeting = closest_approach(Ray(first_origin, first_way), Ray(second_origin, second_way))
    assert meeting is not None
    assert meeting.gap == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(meeting.midpoint, target, atol=1e-8)
    assert meeting.along_first == pytest.approx(np.linalg.norm(first_way))


def test_skew_rays_report_their_gap_and_the_middle():
    meeting = closest_approach(
        Ray(np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])),
        Ray(np.array([2.0, 3.0, 1.0]), np.array([0.0, -2.0, 0.0])),
    )
    assert meeting is not None
    assert meeting.gap == pytest.approx(1.0)
    np.testing.assert_allclose(meeting.midpoint, [2.0, 0.0, 0.5])
    assert (meeting.along_first, meeting.along_second) == pytest.approx((2.0, 3.0))


def test_meeting_behind_the_origin_has_a_negative_distance():
    meeting = closest_approach(
        Ray(np.array([1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])),
        Ray(np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0])),
    )
    assert meeting is not None
    assert meeting.along_first == pytest.approx(-1.0)


def test_parallel_rays_have_no_closest_approach():
    direction = np.array([0.3, 0.4, 0.1])
    assert closest_approach(Ray(np.zeros(3), direction), Ray(np.ones(3), 2.0 * direction)) is None


def test_ray_meets_the_floor_below():
    hit = meet_plane(Ray(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, -1.0])), (0, 0, 0), (0, 0, 1))
    assert hit is not None
    np.testing.assert_allclose(hit, [1.0, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.5), (1.0, 0.0, 0.0)])
def test_ray_above_the_horizon_misses_the_floor(direction):
    assert meet_plane(Ray(np.array([0.0, 0.0, 1.0]), np.array(direction)), (0, 0, 0), (0, 0, 1)) is None


def test_moved_ray_turns_its_direction_without_shifting_it():
    a_from_b = pose_exp([1.0, 2.0, 3.0, 0.4, -0.2, 0.9])
    ray = Ray(np.array([0.5, 0.1, -0.3]), np.array([0.0, 0.6, 0.8]))
    np.testing.assert_allclose(ray.moved(a_from_b).at(2.0), a_from_b.apply(ray.at(2.0)), atol=1e-12)


def test_ray_without_a_direction_is_refused():
    with pytest.raises(InputError, match="must point somewhere"):
        Ray(np.zeros(3), np.zeros(3))
