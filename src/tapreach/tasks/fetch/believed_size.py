"""Which size of a thing is planned for: as it was measured, or, where that is not believed, a usual one."""

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.reach import OFF_FLOOR, is_narrower_elsewhere
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize

SUPPOSED_WIDTH, SUPPOSED_HEIGHT = 0.06, 0.10
"""What is approached to be measured is supposed to be so large [m]."""
_SUPPOSED_SD = 0.4
"""One sigma of both, as a share."""
_HARDLY_ROOM = 0.75
"""Share of the open claw: what is narrower is gripped well over a corner, too."""
_SURELY_ROUND = 0.9
WIDTH_TOLD_WITHIN = 0.9
WIDTH_TOLD = 2
"""What is too wide by its outline in pictures from farther away [m], or by fewer looks, is first looked at
from near.
"""


def believed(size: ThingSize | NoSize, world_from_base: PlanarPose, body: Body) -> ThingSize | NoSize:
    """Return the size, or why it is not believed: from far, or by one look alone, what stands close to the
    thing may pass for part of it.
    """
    if isinstance(size, NoSize) or not size.by_picture:
        return size
    is_too_wide = size.width > body.claw.opens_to
    stands_on = (size.goes_on_above or size.is_post) and size.foot <= OFF_FLOOR
    if not is_too_wide and not stands_on:
        return size
    off = np.asarray(size.axis_in_world)[:2] - [world_from_base.x, world_from_base.y]
    is_near = float(np.hypot(*off)) <= WIDTH_TOLD_WITHIN
    if is_too_wide and is_near and size.told >= WIDTH_TOLD and not size.is_doubted:
        return size
    looks = f"{1000.0 * size.width:.0f} mm wide and {1000.0 * size.height:.0f} mm high"
    return NoSize(f"it looks {looks} from here; what stands close to it may pass for part of it")


def looks_over_its_corner(size: ThingSize, body: Body) -> bool:
    """Tell whether what is too wide from here is probably a box, and narrower from another side."""
    is_told = size.told >= WIDTH_TOLD and not size.goes_on_above and not size.is_doubted
    return is_told and is_narrower_elsewhere(size, body.claw)


def may_be_over_its_corner(size: ThingSize, body: Body) -> bool:
    """Tell whether it may be a box that was gripped over its corner, which is squeezed out of the claw."""
    is_wide = size.width >= _HARDLY_ROOM * body.claw.opens_to
    return is_wide and size.footprint.round_odds < _SURELY_ROUND


def supposed_size(thing: Thing, world_from_base: PlanarPose) -> ThingSize:
    """Return what a thing of unknown size is taken for until it is measured: standing on the floor."""
    point = np.asarray(thing.point_in_world, dtype=np.float64)
    off = point[:2] - [world_from_base.x, world_from_base.y]
    behind = SUPPOSED_WIDTH / 2.0 * off / max(float(np.hypot(*off)), 1e-9)
    height = max(SUPPOSED_HEIGHT, 1.2 * float(point[2]))
    axis = np.array([*(point[:2] + behind), height / 2.0])
    width_sd, height_sd = _SUPPOSED_SD * SUPPOSED_WIDTH, _SUPPOSED_SD * height
    cov = np.asarray(thing.point_cov_in_world, dtype=np.float64)
    return ThingSize(SUPPOSED_WIDTH, width_sd, height, height_sd, 0.0, axis, cov, "its size is supposed")
