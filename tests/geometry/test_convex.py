"""Hulls and distances of convex figures, against brute force."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.convex import convex_hull, distances_from_polygon, segment_distances

places = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))


def along(start: tuple[float, float], end: tuple[float, float], count: int = 400) -> np.ndarray:
    return np.linspace(start, end, count)


@given(st.lists(places, min_size=3, max_size=20))
def test_hull_has_all_points_on_its_left(points):
    hull = convex_hull(points)
    if len(hull) < 3:
        return
    for corner, following in zip(hull, np.roll(hull, -1, axis=0), strict=True):
        way, off = following - corner, np.array(points) - corner
        assert (way[0] * off[:, 1] - way[1] * off[:, 0] >= -1e-9).all()


@given(st.lists(places, min_size=1, max_size=12))
def test_corners_of_a_hull_are_points_given(points):
    assert {tuple(corner) for corner in convex_hull(points)} <= {tuple(point) for point in points}


def test_hull_of_a_square_leaves_out_what_lies_on_its_edges():
    hull = convex_hull([(0, 0), (1, 0), (2, 0), (2, 2), (0, 2), (1, 1)])
    np.testing.assert_array_equal(hull, [(0, 0), (2, 0), (2, 2), (0, 2)])


def test_points_in_a_line_leave_its_ends():
    np.testing.assert_array_equal(convex_hull([(1, 1), (0, 0), (2, 2), (2, 2)]), [(0, 0), (2, 2)])


@pytest.mark.parametrize("points", [np.zeros((0, 2)), [(0.0, math.nan)]])
def test_hull_of_nothing_or_of_nan_is_refused(points):
    with pytest.raises(InputError):
        convex_hull(points)


@settings(max_examples=60)
@given(places, places, places, places)
def test_distance_of_segments_is_that_of_their_nearest_points(a, b, c, d):
    found = segment_distances(*(np.array([each]) for each in (a, b, c, d)))[0, 0]
    apart = np.linalg.norm(along(a, b)[:, None] - along(c, d)[None], axis=2).min()
    spacing = (math.dist(a, b) + math.dist(c, d)) / 399
    assert found <= apart + 1e-9
    assert apart <= found + spacing


@settings(max_examples=60)
@given(st.lists(places, min_size=3, max_size=8), places, places)
def test_distance_from_a_polygon_is_zero_within_and_that_of_its_edges_without(points, start, end):
    hull = convex_hull(points)
    found = distances_from_polygon(hull, np.array([start]), np.array([end]))[0]
    shares = np.random.default_rng(1).dirichlet(np.full(len(hull), 0.3), 3000)
    inside = np.concatenate([shares @ hull, hull])
    apart = np.linalg.norm(inside[:, None] - along(start, end, 60)[None], axis=2).min()
    assert found <= apart + 1e-9
    if apart == 0.0:
        assert found == 0.0


def test_segment_within_a_polygon_touches_it():
    square = convex_hull([(0, 0), (2, 0), (2, 2), (0, 2)])
    assert distances_from_polygon(square, np.array([(1.0, 1.0)]), np.array([(1.2, 1.0)]))[0] == 0.0
    assert distances_from_polygon(square, np.array([(3.0, 1.0)]), np.array([(4.0, 1.0)]))[0] == 1.0
