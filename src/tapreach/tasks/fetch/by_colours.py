"""A thing's own colours: learned while it is seen, and used to find it where it looks otherwise by now."""

from dataclasses import replace

import numpy as np

from tapreach.errors import FrameError
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.messages import Frame
from tapreach.tasks.fetch.expected_box import expected_box, known_at_spot, projected
from tapreach.tasks.fetch.known_thing import KnownThing
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap
from tapreach.vision.extent_place import place_to_follow
from tapreach.vision.image_io import BrokenPicture, decode_color, decode_gray
from tapreach.vision.own_colours import OwnColours, evidence, has_colours, own_colours
from tapreach.vision.seen_again_colours import LEAST_COMMON, ExpectedBox, box_by_colours

_SURELY_ITS = 0.5
"""So much of the thing around a spot of it is its own."""
_AS_KNOWN, _FARTHER_OFF = (1.0, LEAST_COMMON), (2.5, 0.6)
"""How many times worse its place may be known, and how much of its colours it must have there: what is not
where it should be is met farther off only with most of them, as a robot that bumped into something finds it.
"""
_WELL_KNOWN_SD = 0.06
"""Of a place known worse than this [m] nothing is farther off: others alike would be met first."""
_SURELY_COMMON = 0.5
"""What has so much in common with the colours known shows the thing: Bhattacharyya's coefficient."""


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
    spot = projected(known.place.point_in_world, here, description)
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
    seen = None if isinstance(picture, BrokenPicture) else own_colours(picture, box)
    if known is None or seen is None:
        return known or seen
    return known.joined(seen) if known.common(seen) > _SURELY_COMMON else known


async def tap_by_colours(run: FetchRun, frame: Frame, here: PlanarPose) -> Tap | None:
    """Return a tap on the thing where a picture taken at `here` shows its colours; None where it does not.

    From then on the spot tapped is the one that is known. What is found only as a thing of usual size was
    measured wrongly, together with what stands beside it: its size is forgotten.
    """
    known, description = run.memory.known, run.context.description
    if known is None or known.colours is None:
        return None
    for supposed, times, least in _suppositions(known):
        there = expected_box(supposed, here, description)
        if there is None:
            continue
        found = await run.context.compute.call(
            _found, frame.jpeg, known.colours, there.less_sure(times), least
        )
        if found is None:
            continue
        if supposed is not known:
            run.forget()
        box, spot = found
        run.remember(known=known_at_spot(supposed, spot, box, here, description))
        return Tap(frame.frame_id, spot.u, spot.v)
    return None


async def is_seen_there(run: FetchRun, frame: Frame, here: PlanarPose) -> bool:
    """Tell whether a picture taken at `here` shows the thing's colours where it is known to be."""
    known = run.memory.known
    there = expected_box(known, here, run.context.description) if known is not None else None
    if known is None or known.colours is None or there is None:
        return False
    return await run.context.compute.call(_found, frame.jpeg, known.colours, there, LEAST_COMMON) is not None


def _suppositions(known: KnownThing) -> list[tuple[KnownThing, float, float]]:
    """Return what is sought one after the other: as which thing, how many times less sure of its place, and
    with how much of its colours.
    """
    as_usual = [] if known.size is None else [(replace(known, size=None, axis_offset=None), *_AS_KNOWN)]
    is_well_known = float(np.linalg.eigvalsh(known.place.cov_in_world)[-1]) < _WELL_KNOWN_SD**2
    return [(known, *_AS_KNOWN), *as_usual, *([(known, *_FARTHER_OFF)] if is_well_known else [])]


def _found(
    jpeg: bytes, colours: OwnColours, there: ExpectedBox, least: float
) -> tuple[PixelBox, Pixel] | None:
    """Return the box around it, and the place in it that is followed best."""
    picture, gray = decode_color(jpeg), decode_gray(jpeg)
    if isinstance(picture, BrokenPicture) or isinstance(gray, BrokenPicture):
        return None
    box = box_by_colours(picture, colours, there, least)
    if box is None:
        return None
    shown = box.within(ImageSize(gray.shape[1], gray.shape[0]))
    return box, place_to_follow(gray, shown, evidence(picture, colours) > 0.0)


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
