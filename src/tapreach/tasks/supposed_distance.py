"""How far a target may be, for planning a move: from the estimate so far, or from where its ray meets the
floor. It never enters the answer.
"""

import math

from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.ray import Ray

UNKNOWN = (0.6, 1.2, 2.0, 4.0)
"""Distances [m] planned for when nothing is known, and beyond which the floor bounds nothing."""
HEIGHTS = (0.55, 0.3, 0.08)
"""How high up a thing on the floor is tapped, as a share of the camera's height: things are small."""
_FARTHEST = 6.0
_NEAREST = 0.25


def supposed_distances(
    ray_in_world: Ray, estimate: PointEstimate | None, tilt_sigma: float = 0.0
) -> tuple[float, ...]:
    """Return distances [m] along the tapped ray that a move must suit, the nearest first, equally likely.

    With an estimate: both ends of its range interval and the middle. Without: a thing that is seen before
    the floor stands on it, tapped at some of HEIGHTS, or lies where the ray meets the floor if it looks
    up by `tilt_sigma` [rad] more than supposed; above the horizon anything goes.
    """
    if estimate is not None and estimate.range_interval_95 is not None:
        return _of_estimate(estimate, *estimate.range_interval_95)
    height = float(ray_in_world.origin[2])
    direction = ray_in_world.direction
    depression = math.atan2(-float(direction[2]), math.hypot(float(direction[0]), float(direction[1])))
    if height <= 0.0 or depression <= 0.0:
        return UNKNOWN
    floor = height / math.sin(depression)
    higher = depression - tilt_sigma
    farthest = height / math.sin(higher) if higher > 0.0 else _FARTHEST
    supposed = [*(floor * (1.0 - share) for share in HEIGHTS), max(floor, farthest)]
    return tuple(max(min(pair), _NEAREST) for pair in zip(supposed, UNKNOWN, strict=True))


def _of_estimate(estimate: PointEstimate, low: float, high: float | None) -> tuple[float, ...]:
    far = min(high if high is not None else _FARTHEST, _FARTHEST)
    low = max(min(low, far), _NEAREST)
    middle = estimate.range if estimate.range is not None else (low * far) ** 0.5
    return (low, min(max(middle, low), max(far, low)), max(far, low))
