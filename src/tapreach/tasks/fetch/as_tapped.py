"""Whether what is about to be gripped has the colours of the spot that was tapped.

What was tapped from far beside other things, or half behind them, may have been lost to one of those on the
way, with its place, its size and its looks. The tap itself is what the operator said.
"""

import numpy as np

from tapreach.errors import FrameError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.tasks.fetch.expected_box import expected_box, projected
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.optics import optics_of
from tapreach.tasks.sighting import Sighting
from tapreach.vision.image_io import BrokenPicture, decode_color
from tapreach.vision.tapped_colours import TappedSpot, colours_around, common_with

AROUND = 0.015
"""So far around the spot tapped [m] its colours are the thing's."""
LEAST_COMMON = 0.4
"""Each of 43 things tapped had so much in common with the spot, and two of five others near them."""


async def remember_tapped(run: FetchRun) -> None:
    """Keep the colours of what was tapped, now that its distance is known."""
    estimate = run.locating.estimate if run.locating is not None else None
    if estimate is None or estimate.point_in_world is None:
        return
    first = estimate.sightings[0]
    try:
        jpeg = run.context.frames.get(first.frame_id).jpeg
    except FrameError:
        return
    distance = _distance(run, first, estimate.point_in_world)
    half = run.context.description.camera.fx * AROUND / distance
    colours = await run.context.compute.call(_colours, jpeg, first.pixel, half)
    if colours is not None:
        run.remember(tapped=TappedSpot(colours, distance))


async def looks_as_tapped(run: FetchRun) -> bool:
    """Tell whether the thing, where it is followed now, may be what was tapped; True where nothing tells."""
    tapped, known, description = run.memory.tapped, run.memory.known, run.context.description
    follower = run.locating.follower if run.locating is not None else None
    if tapped is None or known is None or follower is None or follower.loss or not follower.sightings:
        return True
    seen, point = follower.last, known.place.point_in_world
    spot = projected(point, seen.world_from_base, description)
    there = expected_box(known, seen.world_from_base, description)
    if spot is None or there is None:
        return True
    try:
        jpeg = run.context.frames.get(seen.frame_id).jpeg
    except FrameError:
        return True
    box = there.box_at(there.pixel + seen.pixel.to_array() - spot)
    scale = _distance(run, seen, point) / tapped.distance
    return await run.context.compute.call(_is_like, jpeg, box, scale, tapped.colours)


def _distance(run: FetchRun, sighting: Sighting, point: FloatArray) -> float:
    mount = optics_of(run.context.description.camera)[1]
    eye = (sighting.world_from_base.to_rigid() * mount).translation
    return float(np.linalg.norm(point - eye))


def _colours(jpeg: bytes, spot: Pixel, half: float) -> FloatArray | None:
    picture = decode_color(jpeg)
    return None if isinstance(picture, BrokenPicture) else colours_around(picture, spot, half)


def _is_like(jpeg: bytes, box: PixelBox, scale: float, colours: FloatArray) -> bool:
    picture = decode_color(jpeg)
    if isinstance(picture, BrokenPicture):
        return True
    return common_with(picture, box, scale, colours) >= LEAST_COMMON
