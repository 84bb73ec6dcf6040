"""How far a target may be, for planning a move: from the estimate so far, or from where its ray meets the
floor.
"""

from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.ray import Ray, meet_plane

UNKNOWN = (0.6, 1.5, 4.0)
"""Distances [m] planned for when nothing is known."""
_FARTHEST = 6.0
_NEAREST = 0.25


def supposed_distances(ray_in_world: Ray, estimate: PointEstimate | None) -> tuple[float, ...]:
    """Return distances [m] along the tapped ray that a move must suit, the nearest first.

    With an estimate: both ends of its range interval and the middle. Without: a thing that is seen before
    the floor stands on it or nearer; above the horizon anything goes.
    """
    if estimate is not None and estimate.range_interval_95 is not None:
        low, high = estimate.range_interval_95
        far = min(high if high is not None else _FARTHEST, _FARTHEST)
        low = max(min(low, far), _NEAREST)
        middle = estimate.range if estimate.range is not None else (low * far) ** 0.5
        return (low, min(max(middle, low), max(far, low)), max(far, low))
    floor = meet_plane(ray_in_world, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    if floor is None:
        return UNKNOWN
    distance = min(float(((floor - ray_in_world.origin) ** 2).sum() ** 0.5), _FARTHEST)
    return tuple(max(_NEAREST, distance * share) for share in (0.5, 0.75, 1.0))
