"""A thing's own colours: learned while it is seen, and used to find it where it looks otherwise by now."""

import math
from dataclasses import replace

import cv2
import numpy as np

from tapreach.errors import FrameError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import Frame
from tapreach.tasks.fetch.known_thing import KnownThing
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.optics import optics_of
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap
from tapreach.vision.extent_place import place_to_follow
from tapreach.vision.image_io import BrokenPicture, decode_color
from tapreach.vision.own_colours import OwnColours, has_colours, own_colours
from tapreach.vision.seen_again_colours import ExpectedBox, box_by_colours

_AT_REST_PX = 5.0
"""A camera that rocks, and a picture's own errors, one sigma [px]."""
_LEAST_SCALE, _MOST_SCALE = 0.1, 0.25
"""By how much nearer or farther it may be, at least and at most, one sigma."""
_NEAREST = 0.08
"""Nearer to the camera [m] the whole thing is never in the picture."""
_STEP_M = 0.002
_SURELY_ITS = 0.5
"""So much of the thing around a spot of it is its own."""


async def learn_colours(run: FetchRun) -> None:
    """Add what the newest sighting shows of the thing's colours to those known, while nothing speaks against
    its being the thing; the first one, which was tapped, tells them where nothing is known yet.
    """
    known, locating = run.memory.known, run.locating
    estimate = locating.estimate if locating is not None else None
    if known is None or locating is None or estimate is None:
        return
    is_sure = not locating.follower.loss and not locating.follower.doubt
    tapped = [] if known.colours is not None else [estimate.sightings[0]]
    for sighting in [*tapped, *([locating.follower.last] if is_sure else [])]:
        known = replace(known, colours=await _colours_in(run, known, sighting))
    run.remember(known=known)


async def _colours_in(run: FetchRun, known: KnownThing, sighting: Sighting) -> OwnColours | None:
    """Return the colours known with those that a sighting shows."""
    description, here = run.context.description, sighting.world_from_base
    spot = _projected(known.place.point_in_world, here, description)
    there = expected_box(known, here, description)
    if spot is None or there is None:
        return known.colours
    try:
        jpeg = run.context.frames.get(sighting.frame_id).jpeg
    except FrameError:
        return known.colours
    box = there.box_at(there.pixel + sighting.pixel.to_array() - spot)
    return await run.context.compute.call(_with_view, known.colours, jpeg, box)


def _with_view(known: OwnColours | None, jpeg: bytes, box: PixelBox) -> OwnColours | None:
    """Return the colours known with those of what fills `box`; as they are where that shows others."""
    picture = decode_color(jpeg)
    if isinstance(picture, BrokenPicture) or (known and not has_colours(picture, known, box)):
        return known
    seen = own_colours(picture, box)
    return known.joined(seen) if known and seen else seen or known


async def tap_by_colours(run: FetchRun, frame: Frame, here: PlanarPose) -> Tap | None:
    """Return a tap on the thing where a picture taken at `here` shows its colours; None where it does not.

    From then on the spot tapped is the one that is known.
    """
    known, description = run.memory.known, run.context.description
    if known is None or known.colours is None:
        return None
    there = expected_box(known, here, description)
    if there is None:
        return None
    found = await run.context.compute.call(_found, frame.jpeg, known.colours, there)
    if found is None:
        return None
    box, spot = found
    run.remember(known=_at_spot(known, spot, box, here, description))
    return Tap(frame.frame_id, spot.u, spot.v)


def _found(jpeg: bytes, colours: OwnColours, there: ExpectedBox) -> tuple[PixelBox, Pixel] | None:
    """Return the box around it, and the place in it that is followed best."""
    picture = decode_color(jpeg)
    box = None if isinstance(picture, BrokenPicture) else box_by_colours(picture, colours, there)
    if box is None or isinstance(picture, BrokenPicture):
        return None
    gray = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8)
    return box, place_to_follow(gray, box.within(ImageSize(*reversed(gray.shape))))


def expected_box(known: KnownThing, here: PlanarPose, description: RobotDescription) -> ExpectedBox | None:
    """Return where all of the thing should be in a picture taken at `here`; None where its middle would not
    be in it.
    """
    place, middle = known.place.seen_from(here, description), known.middle
    pixel = _projected(middle, here, description)
    beside = [_projected(middle + _STEP_M * axis, here, description) for axis in np.eye(3)]
    camera, mount, _ = optics_of(description.camera)
    if pixel is None or any(each is None for each in beside) or not Pixel(*pixel).is_inside(camera.size):
        return None
    by_point = (np.array(beside) - pixel).T / _STEP_M
    covariance = by_point @ place.cov_in_world @ by_point.T + _AT_REST_PX**2 * np.eye(2)
    depth = float((here.to_rigid() * mount).inv().apply(middle)[2])
    distance_sd = math.sqrt(float(np.linalg.eigvalsh(place.cov_in_world)[-1]))
    step = 1.0 + min(max(distance_sd / depth, _LEAST_SCALE), _MOST_SCALE)
    half_width, half_height = camera.fx / depth * known.half_size
    scales = tuple(step**power for power in (0, -1, 1, -2, 2))
    return ExpectedBox(pixel, covariance, float(half_width), float(half_height), scales)


def _projected(point: FloatArray, here: PlanarPose, description: RobotDescription) -> FloatArray | None:
    """Return where a point (3,) [m] falls, (2,) [px], in the picture or beside it; None nearer than 8 cm."""
    camera, mount, _ = optics_of(description.camera)
    in_camera = (here.to_rigid() * mount).inv().apply(point)
    projection = camera.project(in_camera[None])
    return projection.pixels[0] if in_camera[2] > _NEAREST and projection.is_valid[0] else None


def _at_spot(
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


async def is_of_its_colours(run: FetchRun, frame: Frame, pixel: Pixel, here: PlanarPose) -> bool:
    """Tell whether what a picture taken at `here` shows around a pixel may be the thing by its colours."""
    known = run.memory.known
    there = expected_box(known, here, run.context.description) if known is not None else None
    if known is None or known.colours is None or there is None:
        return True
    around = there.box_at(pixel.to_array()).inner(_SURELY_ITS)
    return await run.context.compute.call(_is_alike, frame.jpeg, known.colours, around)


def _is_alike(jpeg: bytes, colours: OwnColours, box: PixelBox) -> bool:
    picture = decode_color(jpeg)
    return isinstance(picture, BrokenPicture) or has_colours(picture, colours, box)
