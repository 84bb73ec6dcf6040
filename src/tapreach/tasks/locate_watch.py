"""Why a move that is being made for locating should end here and now."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.geometry.ray import Ray
from tapreach.robot.clock import MS
from tapreach.robot.config import RobotDescription
from tapreach.tasks.candidate_moves import NEAREST
from tapreach.tasks.sighting import Sighting, ray_of

EDGE = 0.035
"""A target that moves outwards this near to the picture's edge is about to be lost; share of the picture."""
BLOCKED = "the wheels turn but the picture stands still: something blocks the robot"
SLIPPING = "the wheels slip, by what the picture shows: something may be in the way"
HIDDEN = "the target is out of sight"
_RECENT, _SLIPS = 8, 2
"""Of so many sightings, so many ways in a row that show a slip are no chance."""
HARDLY_KNOWN = 0.1
"""A relative error of the range, one sigma, beyond which it is not driven up to what is not seen."""
LOST_NS = 600 * MS
"""So long it may be out of sight, as a passing shadow or arm makes it, before driving on has no purpose."""


def is_accurate(estimate: PointEstimate | None, accuracy: float) -> bool:
    """Tell whether the range is known with a relative error (one sigma) no larger than wanted."""
    return estimate is not None and estimate.status is Status.DETERMINED and estimate.relative_sd <= accuracy


def is_hardly_known(estimate: PointEstimate | None) -> bool:
    """Tell whether too little is known of its place to drive up to it where it is not seen."""
    return not is_accurate(estimate, HARDLY_KNOWN)


@dataclass(frozen=True)
class MoveWatch:
    """Watches one move. ray: the first line of sight. nearest: where on it the target may be at the nearest
    [m], as long as no estimate says better.
    """

    description: RobotDescription
    accuracy: float
    ray: Ray
    nearest: float
    is_forward: bool

    def reason_to_stop(
        self, sightings: list[Sighting], estimate: PointEstimate | None, unseen_ns: int
    ) -> str:
        """Return why, '' while the move may go on. unseen_ns: how long the target has not been seen."""
        if is_accurate(estimate, self.accuracy):
            return "the wanted accuracy is reached"
        if obstruction := _obstruction(sightings):
            return obstruction
        if unseen_ns >= LOST_NS:
            return HIDDEN
        if self.is_forward and self._is_too_near(sightings[-1], estimate):
            return "the target may be right ahead"
        if len(sightings) > 1 and self._leaves_the_picture(sightings[-2], sightings[-1]):
            return "the target is about to leave the picture"
        return ""

    def _is_too_near(self, last: Sighting, estimate: PointEstimate | None) -> bool:
        nearest = self.ray.at(self._nearest_by(estimate))
        camera = ray_of(last, self.description).origin
        return float(np.linalg.norm(nearest - camera)) < NEAREST

    def _nearest_by(self, estimate: PointEstimate | None) -> float:
        """Return the nearest distance left [m]; views from almost one place say less than was supposed."""
        if estimate is None or estimate.range_interval_95 is None:
            return self.nearest
        least = estimate.range_interval_95[0]
        return least if estimate.status is Status.DETERMINED else max(least, self.nearest)

    def _leaves_the_picture(self, before: Sighting, last: Sighting) -> bool:
        """Tell whether it would be too near to the edge in the next frame, going on as it does."""
        now, then = last.pixel, before.pixel
        coming = self._from_edge(2.0 * now.u - then.u, 2.0 * now.v - then.v)
        return coming < EDGE and coming < self._from_edge(now.u, now.v)

    def _from_edge(self, u: float, v: float) -> float:
        """Return how far inside the picture a pixel is, as a share of the picture."""
        size = self.description.camera.model().size
        across, down = u / size.width, v / size.height
        return min(across, down, 1.0 - across, 1.0 - down)


def is_blocked(sightings: Sequence[Sighting]) -> bool:
    """Tell whether by the newest way that the background shows the wheels turn and nothing moves."""
    ways = [each.way for each in sightings[-_RECENT:] if each.way is not None]
    return bool(ways) and ways[-1].stands_still


def _obstruction(sightings: list[Sighting]) -> str:
    if is_blocked(sightings):
        return BLOCKED
    ways = [each.way for each in sightings[-_RECENT:] if each.way is not None]
    slipped = [way.knowledge.has_slipped for way in ways[-_SLIPS:]]
    return SLIPPING if len(slipped) == _SLIPS and all(slipped) else ""
