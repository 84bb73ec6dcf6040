"""Places in the world that surely stand up from the floor, by pictures from different places."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.tasks.fetch.standing_views import StandingView, compared_with, references
from tapreach.vision.floor_alignment import aligned_on_floor
from tapreach.vision.plane_sweep import swept
from tapreach.vision.standing import standing_pixels

LOWEST, HIGHEST = 0.025, 0.35
"""What is lower is driven over, what is higher is driven under [m]."""
FARTHEST, SURELY_WITHIN = 1.3, 1.7
"""What is farther, or may be, is left for the next look [m] from the camera."""
_INVERSE_DEPTHS = np.arange(0.2, 3.8, 0.075)
_FLOORS = np.array([-0.01, 0.005])
"""The floor may be so high [m]."""
_FLOOR_SEEN = 2.2
_MOST_RATIO = 1.5
"""Of the farthest to the nearest distance at which it may be."""


@dataclass(frozen=True, eq=False)
class StandingPoints:
    """n points (n, 3) in the world [m]; areas (n,) [m²] that they stand for across the line of sight;
    cameras (n, 2): from where each was seen; spreads (n,) [m]: how much farther or nearer it may be.
    """

    points: FloatArray
    areas: FloatArray
    cameras: FloatArray
    spreads: FloatArray

    def where(self, is_kept: NDArray[np.bool_]) -> "StandingPoints":
        """Return some of them, by (n,)."""
        return StandingPoints(
            self.points[is_kept], self.areas[is_kept], self.cameras[is_kept], self.spreads[is_kept]
        )

    @classmethod
    def joined(cls, parts: Sequence["StandingPoints"]) -> "StandingPoints":
        """Return all of them together; there may be none."""
        nothing = StandingPoints(np.zeros((0, 3)), np.zeros(0), np.zeros((0, 2)), np.zeros(0))
        every = [nothing, *parts]
        return cls(
            np.concatenate([part.points for part in every]),
            np.concatenate([part.areas for part in every]),
            np.concatenate([part.cameras for part in every]),
            np.concatenate([part.spreads for part in every]),
        )


def standing_points(views: Sequence[StandingView]) -> StandingPoints:
    """Return what stands up from the floor in the views, as seen from three of them."""
    if len(views) < 2:
        return StandingPoints.joined([])
    return StandingPoints.joined([_seen_from(views, reference) for reference in references(views)])


def _seen_from(views: Sequence[StandingView], reference: int) -> StandingPoints:
    here, others = views[reference], [views[i] for i in compared_with(views, reference)]
    if not others:
        return StandingPoints.joined([])
    pictures = [other.picture for other in others]
    by_floors = np.stack([_by_aligned_floors(here, other) for other in others], axis=1)
    by_depths = np.stack([here.by_depths(other, _INVERSE_DEPTHS) for other in others], axis=1)
    of_floor = swept(here.picture, pictures, by_floors).min(axis=0)
    found = standing_pixels(swept(here.picture, pictures, by_depths), _INVERSE_DEPTHS, of_floor)
    depths = 1.0 / found.best
    directions = here.directions(found.columns, found.rows)
    points = here.place + depths[:, None] * directions
    is_kept = (points[:, 2] > LOWEST) & (points[:, 2] < HIGHEST)
    is_kept &= (depths < FARTHEST) & (found.farthest * SURELY_WITHIN > 1.0)
    is_kept &= found.nearest < _MOST_RATIO * found.farthest
    areas = depths**2 / (here.matrix[0, 0] * here.matrix[1, 1])
    cameras = np.tile(here.place[:2], (len(points), 1))
    spreads = (1.0 / found.farthest - 1.0 / found.nearest) / 2.0
    return StandingPoints(points, areas, cameras, spreads).where(is_kept)


def _by_aligned_floors(here: StandingView, other: StandingView) -> FloatArray:
    floor = here.by_floors(other, np.zeros(1))[0]
    aligned = aligned_on_floor(here.picture, other.picture, floor, here.may_show_floor(_FLOOR_SEEN))
    return np.asarray(aligned @ here.by_floors(other, _FLOORS))
