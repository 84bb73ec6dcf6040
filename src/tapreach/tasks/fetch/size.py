"""How large the tapped thing is, from the views already taken: what moved as the thing does is cut out.

One view after the other is the reference: its outline is cut out on an upright raster through the located
point, with the parallax to the other views (vision/thing_*). Two references must agree.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tapreach.errors import FrameError
from tapreach.estimation.thing_size import FusedSize, Silhouette, agreeing, fused, silhouette_of_box
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import wrapped
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.extent import extent_of
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tapreach.tasks.fetch.thing_views import Seen, ThingView, references, seen_from, views_of
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import TaskContext
from tapreach.vision.thing_cut import BOUND

BY_PICTURE, BY_BOX = "by the picture", "by the box"
AT_LEAST = "at least so wide"
_LEAST_VIEWS = 3
_TOLD = 0.15
"""Of what is wider [m] the size is told though its sides are not both seen."""
_SAME_SIDE = math.radians(20.0)
"""Seen from farther aside than this from the newest place a box has another outline."""
_CUT = 0.3
"""Share of the rows that the picture's edge cuts off."""


async def size_of(
    context: TaskContext, located: LocatedPoint, box: PixelBox | None = None
) -> ThingSize | NoSize:
    """Return the size of a located thing: by the box drawn around it in the first of the sightings, else from
    all of them, as far as their pictures are still kept.
    """
    if box is not None:
        return boxed_size(box, located, context.description)
    jpegs: dict[int, bytes] = {}
    for sighting in located.sightings:
        try:
            jpegs[sighting.frame_id] = context.frames.get(sighting.frame_id).jpeg
        except FrameError:
            continue
    point, covariance = located.point_in_world, located.point_cov_in_world
    if point is None or covariance is None:
        return NoSize("its position is not known")
    kept = [each for i, each in enumerate(located.sightings) if i not in located.rejected_views]
    return await context.compute.call(
        thing_size, point, covariance, located.relative_sd, kept, jpegs, context.description
    )


def boxed_size(box: PixelBox, located: LocatedPoint, description: RobotDescription) -> ThingSize | NoSize:
    """Return the size of what a box holds that was drawn in the first of the sightings."""
    first, point, covariance = located.sightings[0], located.point_in_world, located.point_cov_in_world
    extent = extent_of(box, first, located, description)
    if extent is None or point is None or covariance is None:
        return NoSize("its position is not known")
    if extent.size is None:
        return NoSize(extent.reason)
    by_box = silhouette_of_box(extent.size, point, math.sqrt(float(covariance[2, 2])))
    size = fused([by_box], point, covariance, located.relative_sd)
    size = replace(size, width_sd=extent.size.width_sd, height_sd=extent.size.height_sd)
    return _told(size, [BY_BOX, AT_LEAST if extent.reason else ""])


def thing_size(
    point_in_world: FloatArray,
    point_cov_in_world: FloatArray,
    relative_sd: float,
    sightings: Sequence[Sighting],
    jpegs: Mapping[int, bytes],
    description: RobotDescription,
) -> ThingSize | NoSize:
    """Return the size of what was followed to a located point (3,) [m], with covariance (3, 3) [m²].

    relative_sd: of its distance. sightings: with their poses as now known, in the order of time. jpegs: their
    pictures by frame id; those without one are left out.
    """
    views = _from_one_side(views_of(sightings, jpegs, description, point_in_world), point_in_world)
    if len(views) < _LEAST_VIEWS:
        return NoSize(f"only {len(views)} pictures of it from this side: locate it again")
    point_height_sd = float(np.sqrt(point_cov_in_world[2, 2]))
    seen: list[Seen] = []
    for reference in references(views, point_in_world):
        found = seen_from(views, reference, point_in_world, point_height_sd)
        if found is None:
            continue
        seen.append(found)
        pair = agreeing([each.silhouette for each in seen if each.cut.is_bounded])
        if pair:
            told = _told(fused(pair, point_in_world, point_cov_in_world, relative_sd), [BY_PICTURE])
            goes_on = all(each.goes_on_above for each in _of(pair, seen))
            cut = all(each.cut.is_cut_above for each in _of(pair, seen))
            return replace(told, goes_on_above=goes_on, is_cut_above=cut, seen_along=_sight_along(pair))
    wide = [each.silhouette for each in seen if each.silhouette.width > _TOLD]
    if wide and len(wide) == len(seen):
        return _told(fused(wide, point_in_world, point_cov_in_world, relative_sd), [BY_PICTURE, AT_LEAST])
    whole = [each.silhouette for each in seen if each.cut.is_bounded and not each.goes_on_above][:1]
    alone = (
        _told(fused(whole, point_in_world, point_cov_in_world, relative_sd), [BY_PICTURE]) if whole else None
    )
    return _unmeasured(seen, alone)


def _from_one_side(views: Sequence[ThingView], point: FloatArray) -> list[ThingView]:
    """Return the views from about where the newest is from."""
    ways = [point - view.placed.world_from_camera.translation for view in views]
    along = [math.atan2(way[1], way[0]) for way in ways]
    return [
        view for view, one in zip(views, along, strict=True) if abs(wrapped(one - along[-1])) <= _SAME_SIDE
    ]


def _sight_along(seen: Sequence[Silhouette]) -> float:
    """Return the mean direction in the world of the lines of sight [rad]."""
    x, y, _ = np.sum([each.ahead for each in seen], axis=0)
    return math.atan2(y, x)


def _of(pair: Sequence[Silhouette], seen: Sequence[Seen]) -> list[Seen]:
    return [each for each in seen if any(each.silhouette is one for one in pair)]


def _told(size: FusedSize, words: list[str]) -> ThingSize:
    if size.foot > 0.0:
        words.append(f"stands {100.0 * size.foot:.0f} cm above the floor")
    return ThingSize(
        size.width,
        size.width / 2.0 if AT_LEAST in words else size.width_sd,
        size.height,
        size.height_sd,
        size.foot,
        size.axis_in_world,
        size.axis_cov_in_world,
        ", ".join(filter(None, words)),
        by_picture=BY_PICTURE in words,
    )


def _unmeasured(seen: Sequence[Seen], alone: ThingSize | None) -> NoSize:
    """Return why no two views agree on an outline; `alone`: what one of them tells."""
    if not seen:
        return NoSize("it is too near to the camera", alone)
    if sum(each.cut.is_bounded for each in seen) >= 2:
        words = "the views disagree about its outline: something may hide it, or stand close to it"
        return NoSize(words, alone)
    unclear = next((each.cut for each in seen if not each.cut.is_bounded), None)
    if unclear is None:
        return NoSize("only one view shows it well: locate it again from further to the side", alone)
    side = "left" if unclear.bounded[0] < unclear.bounded[1] else "right"
    if max(unclear.cut_off) > _CUT:
        words = f"the picture's edge cuts it off on the {side}"
        return NoSize(f"{words}: look at it from where all of it is in the picture", alone)
    if max(unclear.bounded) < BOUND:
        words = (
            "it lies flat on what is behind it, as a picture on a wall does, or is part of something larger"
        )
    else:
        words = f"its {side} side cannot be told from what is beside or behind it"
    return NoSize(words, alone, denies_sides=True)
