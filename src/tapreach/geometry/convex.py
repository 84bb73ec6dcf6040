"""Convex figures on the floor plane: hulls, and how far line segments are from them."""

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array


def convex_hull(points: npt.ArrayLike) -> FloatArray:
    """Return the corners (k, 2) of the hull of points (n, 2), counter-clockwise from the leftmost lowest.

    Points on an edge are left out; points in one line leave its two ends, equal points one. Raises
    InputError for no points and for coordinates that are not finite. Source: Andrew's monotone chain.
    """
    given = np.unique(finite_array("points", points, (None, 2)), axis=0)
    if len(given) == 0:
        raise InputError("there are no points; a hull is around at least one")
    if len(given) < 3:
        return given
    lower, upper = _chain(given), _chain(given[::-1])
    return np.array([*lower[:-1], *upper[:-1]])


def segment_distances(
    starts: FloatArray, ends: FloatArray, other_starts: FloatArray, other_ends: FloatArray
) -> FloatArray:
    """Return (n, m): how far segments (n, 2) to (n, 2) are from others (m, 2) to (m, 2); 0 where they meet.

    A segment may be a point.
    """
    a, b = starts[:, None], ends[:, None]
    c, d = other_starts[None], other_ends[None]
    apart = np.minimum(
        np.minimum(_from_segment(a, c, d), _from_segment(b, c, d)),
        np.minimum(_from_segment(c, a, b), _from_segment(d, a, b)),
    )
    across = (_side(a, b, c) * _side(a, b, d) < 0.0) & (_side(c, d, a) * _side(c, d, b) < 0.0)
    return np.asarray(np.where(across, 0.0, apart))


def distances_from_polygon(polygon: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return (m,): how far segments (m, 2) to (m, 2) are from a convex polygon (k, 2), counter-clockwise.

    0 where they touch it or lie in it. Fewer than three corners make a segment or a point.
    """
    if len(starts) == 0:
        return np.zeros(0)
    corners, following = polygon, np.roll(polygon, -1, axis=0)
    apart = segment_distances(corners, following, starts, ends).min(axis=0)
    is_inside = (_side(corners[:, None], following[:, None], starts[None]) > 0.0).all(axis=0)
    return np.asarray(np.where(is_inside, 0.0, apart))


def _chain(ordered: FloatArray) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for point in ordered:
        while len(chain) > 1 and float(_side(chain[-2], chain[-1], point)) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _side(starts: FloatArray, ends: FloatArray, points: FloatArray) -> FloatArray:
    """Return twice the signed area of start, end, point: positive where the point lies to the left."""
    way, off = ends - starts, points - starts
    return np.asarray(way[..., 0] * off[..., 1] - way[..., 1] * off[..., 0])


def _from_segment(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    way, off = ends - starts, points - starts
    length2 = np.sum(way * way, axis=-1)
    along = np.sum(off * way, axis=-1) / np.where(length2 > 0.0, length2, 1.0)
    nearest = starts + np.clip(along, 0.0, 1.0)[..., None] * way
    return np.asarray(np.linalg.norm(points - nearest, axis=-1))
