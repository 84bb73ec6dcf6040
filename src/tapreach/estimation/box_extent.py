"""How wide and high a thing is: the box around it in one picture, and how far away it is.

The box's edges are bearings; at the thing's distance they span its size. Measured in the upright plane
through the located point that faces the camera. The point lies on the thing's front, its outline somewhat
farther back, by how much one view cannot tell. The sides of a tin, a ball, or a packet seen over its corner
lie up to half its width behind; foot and top as far for a ball and not at all for tins and packets, but
where the camera looks down on a top it sees the far end of it, one depth of the thing behind.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, finite_array, positive
from tapreach.geometry.gaussian import require_covariance
from tapreach.geometry.pixel_box import PixelBox

EDGE_SIGMA = 3.0
"""How well a person draws an edge [px]."""
_LEAST_AHEAD = 0.02
"""Nearer to straight below or above the camera no upright plane faces it [m]."""
_LEAST_FORWARD = 0.5
"""Rays farther than 60° from the way to the thing meet its plane too flatly to measure by."""
_SIDES, _FOOT, _TOP_FROM_BELOW, _TOP_FROM_ABOVE = (0.28, 0.22), (0.18, 0.24), (0.18, 0.24), (0.8, 0.5)
"""Depth of the outline behind the point, in widths of the thing: mean and sd over the shapes named above."""


@dataclass(frozen=True)
class BoxExtent:
    """Size of a thing in the upright plane that faces the camera [m], with one sigma each [m].

    The sigmas hold edges, range, and the unknown depth of the outline. corners_in_world (4, 3) [m]: the box
    in that plane, left top, right top, right bottom, left bottom as the camera sees it.
    """

    width: float
    height: float
    width_sd: float
    height_sd: float
    corners_in_world: FloatArray


@dataclass(frozen=True)
class NoExtent:
    """Why the box tells no size."""

    reason: str


@dataclass(frozen=True)
class _Edges:
    """Where the edges' rays meet an upright plane one metre ahead: slopes, left and up positive.

    values (4,): left, right, top, bottom; sds (4,).
    """

    values: FloatArray
    sds: FloatArray


@dataclass(frozen=True)
class _Plane:
    """An upright plane that faces the camera: unit normal away from it (3,), distance of the point [m]."""

    ahead: FloatArray
    left: FloatArray
    distance: float


def box_extent(
    box: PixelBox,
    camera: Camera,
    world_from_camera: RigidTransform,
    point_in_world: npt.ArrayLike,
    point_cov_in_world: npt.ArrayLike,
    *,
    edge_sigma: float = EDGE_SIGMA,
) -> BoxExtent | NoExtent:
    """Return the size of what the box holds, seen from `world_from_camera`, z of the world upwards.

    point_in_world (3,) [m]: a place on the thing's front, with covariance (3, 3) [m²]. edge_sigma [px]: of
    each edge. Raises InputError for what is not finite, no covariance, or a box that the lens cannot see.
    """
    point = finite_array("point_in_world", point_in_world, (3,))
    covariance = require_covariance("point_cov_in_world", point_cov_in_world, 3)
    positive("edge_sigma", edge_sigma)
    plane = _plane_through(point, world_from_camera)
    if plane is None:
        return NoExtent("the thing is straight below or above the camera")
    edges = _edges(box, camera, world_from_camera, plane, edge_sigma)
    if edges is None:
        return NoExtent(
            "the box reaches more than 60° to the side of the thing, or the camera is not upright"
        )
    distance_sd = math.sqrt(float(plane.ahead @ covariance @ plane.ahead))
    return _measured(edges, plane, distance_sd, world_from_camera.translation)


def _plane_through(point: FloatArray, world_from_camera: RigidTransform) -> _Plane | None:
    way = point - world_from_camera.translation
    distance = math.hypot(way[0], way[1])
    if distance < _LEAST_AHEAD or float(way @ world_from_camera.rotation.apply([0.0, 0.0, 1.0])) <= 0.0:
        return None
    ahead = np.array([way[0], way[1], 0.0]) / distance
    return _Plane(ahead, np.array([-ahead[1], ahead[0], 0.0]), distance)


def _edges(
    box: PixelBox, camera: Camera, world_from_camera: RigidTransform, plane: _Plane, edge_sigma: float
) -> _Edges | None:
    middle = box.middle
    pixels = np.array(
        [[box.left, middle.v], [box.right, middle.v], [middle.u, box.top], [middle.u, box.bottom]]
    )
    inwards = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    rays = world_from_camera.rotation.apply(camera.unproject(np.concatenate([pixels, pixels + inwards])))
    ahead = rays @ plane.ahead
    if float(ahead.min()) < _LEAST_FORWARD:
        return None
    slopes = np.stack([rays @ plane.left, rays[:, 2]]) / ahead
    values, moved = (np.concatenate([slopes[0, i : i + 2], slopes[1, i + 2 : i + 4]]) for i in (0, 4))
    is_upright = values[0] > values[1] and values[2] > values[3]
    return _Edges(values, np.abs(moved - values) * edge_sigma) if is_upright else None


def _measured(edges: _Edges, plane: _Plane, distance_sd: float, origin: FloatArray) -> BoxExtent:
    """Edges lie at distance + depth of the outline, times their slope; errors to first order."""
    left, right, top, bottom = map(float, edges.values)
    across, distance = left - right, plane.distance
    width = distance * across / (1.0 - _SIDES[0] * across)
    side, foot, rim = (
        (mean * width, sd * width)
        for mean, sd in (_SIDES, _FOOT, _TOP_FROM_ABOVE if top < 0.0 else _TOP_FROM_BELOW)
    )
    height = (distance + rim[0]) * top - (distance + foot[0]) * bottom
    at_edges = distance * edges.sds
    return BoxExtent(
        width,
        height,
        math.hypot(at_edges[0], at_edges[1], across * distance_sd, across * side[1]),
        math.hypot(at_edges[2], at_edges[3], (top - bottom) * distance_sd, top * rim[1], bottom * foot[1]),
        _corners(edges, plane, origin),
    )


def _corners(edges: _Edges, plane: _Plane, origin: FloatArray) -> FloatArray:
    left, right, top, bottom = edges.values
    ways = [(left, top), (right, top), (right, bottom), (left, bottom)]
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([origin + plane.distance * (plane.ahead + y * plane.left + z * up) for y, z in ways])
