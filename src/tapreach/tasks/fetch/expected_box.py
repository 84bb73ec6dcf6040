"""Where all of a known thing should be in a picture; and from where it is found to what is then known."""

import math
from dataclasses import replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.known_thing import KnownThing
from tapreach.tasks.optics import optics_of
from tapreach.vision.seen_again_colours import ExpectedBox

AT_REST_PX = 5.0
"""A camera that rocks, and a picture's own errors, one sigma [px]."""
_LEAST_SCALE, _MOST_SCALE = 0.1, 0.25
"""By how much nearer or farther it may be, at least and at most, one sigma."""
_NEAREST = 0.08
"""Nearer to the camera [m] the whole thing is never in the picture."""


def expected_box(known: KnownThing, here: PlanarPose, description: RobotDescription) -> ExpectedBox | None:
    """Return where all of the thing should be in a picture taken at `here`, or beside it; None where it would
    be behind the camera or as good as at it.
    """
    place, middle = known.place.seen_from(here, description), known.middle
    pixel = projected(middle, here, description)
    camera, mount, _ = optics_of(description.camera)
    if pixel is None:
        return None
    by_point = pixel_by_point(middle, here, description)
    covariance = by_point @ place.cov_in_world @ by_point.T + AT_REST_PX**2 * np.eye(2)
    depth = float((here.to_rigid() * mount).inv().apply(middle)[2])
    distance_sd = math.sqrt(float(np.linalg.eigvalsh(place.cov_in_world)[-1]))
    step = 1.0 + min(max(distance_sd / depth, _LEAST_SCALE), _MOST_SCALE)
    half_width, half_height = camera.fx / depth * known.half_size
    scales = tuple(step**power for power in (0, -1, 1, -2, 2))
    return ExpectedBox(pixel, covariance, float(half_width), float(half_height), scales)


def projected(point: FloatArray, here: PlanarPose, description: RobotDescription) -> FloatArray | None:
    """Return where a point (3,) [m] falls, (2,) [px], in the picture or beside it; None nearer than 8 cm."""
    camera, mount, _ = optics_of(description.camera)
    in_camera = (here.to_rigid() * mount).inv().apply(point)
    projection = camera.project(in_camera[None])
    return projection.pixels[0] if in_camera[2] > _NEAREST and projection.is_valid[0] else None


def pixel_by_point(point: FloatArray, here: PlanarPose, description: RobotDescription) -> FloatArray:
    """Return by how much a pixel moves with its point in the world, (2, 3) [px/m]."""
    camera, mount, _ = optics_of(description.camera)
    camera_from_world = (here.to_rigid() * mount).inv()
    by_camera = camera.project_with_jacobian(camera_from_world.apply(point)[None])[1][0]
    return np.asarray(by_camera @ camera_from_world.rotation.as_matrix())


def known_at_spot(
    known: KnownThing, spot: Pixel, box: PixelBox, here: PlanarPose, description: RobotDescription
) -> KnownThing:
    """Return the thing known by a spot on its front, seen at `spot`, with its middle in the middle of `box`;
    its distance is as it was.
    """
    camera, mount, _ = optics_of(description.camera)
    world_from_camera = here.to_rigid() * mount
    origin = world_from_camera.translation
    ways = world_from_camera.rotation.apply(camera.unproject([spot.to_array(), box.middle.to_array()]))
    to_spot, to_middle = ways / np.hypot(ways[:, 0], ways[:, 1])[:, None]
    distance = float(np.hypot(*(known.middle - origin)[:2]))
    half = known.size.width / 2.0 if known.size is not None else 0.0
    point = origin + (distance - half) * to_spot
    place = replace(known.place.seen_from(here, description), point_in_world=point)
    offset = origin + distance * to_middle - point
    return replace(known, place=place, axis_offset=None if known.axis_offset is None else offset)
