"""A size measured in an earlier look together with that of a new one."""

import math
from dataclasses import replace

from tapreach.geometry.planar_motion import wrapped
from tapreach.tasks.fetch.thing import ThingSize

_SAME_SIGMAS = 3.0
_SAME_SIDE = math.radians(15.0)
"""A thing seen from farther aside than this shows another width."""


def with_earlier(new: ThingSize, earlier: ThingSize | None, seen_along: float) -> ThingSize:
    """Return the new size, made surer by an earlier one as far as both can be of the same side of it.

    seen_along: the new line of sight's direction in the world [rad]. The errors of both are taken to be the
    same error, as they come of one method: the mean is no surer than the better of the two.
    """
    if earlier is None or earlier.seen_along is None or not _agree(new, earlier):
        return new
    height, height_sd = _mean(new.height, new.height_sd, earlier.height, earlier.height_sd)
    if abs(wrapped(seen_along - earlier.seen_along)) > _SAME_SIDE:
        return replace(new, height=height, height_sd=height_sd)
    width, width_sd = _mean(new.width, new.width_sd, earlier.width, earlier.width_sd)
    return replace(new, width=width, width_sd=width_sd, height=height, height_sd=height_sd)


def _agree(new: ThingSize, earlier: ThingSize) -> bool:
    by_width = abs(new.width - earlier.width) / math.hypot(new.width_sd, earlier.width_sd)
    by_height = abs(new.height - earlier.height) / math.hypot(new.height_sd, earlier.height_sd)
    return max(by_width, by_height) <= _SAME_SIGMAS and new.foot == earlier.foot


def _mean(a: float, a_sd: float, b: float, b_sd: float) -> tuple[float, float]:
    """Return the weighted mean of two values, and its sigma where their errors are one and the same."""
    share = b_sd**2 / (a_sd**2 + b_sd**2)
    return share * a + (1.0 - share) * b, share * a_sd + (1.0 - share) * b_sd
