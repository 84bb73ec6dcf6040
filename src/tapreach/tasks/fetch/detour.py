"""Places to drive over on the way round things, and which of them can be driven to from each other.

A visibility graph for a robot that turns on the spot: places on rings around each thing, where it can turn
about freely, joined where the straight corridor between two is free.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.geometry.convex import segment_distances
from tapreach.geometry.finite import FloatArray
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.passage import CLEAR, Passage

_ON_RING = 8
_BESIDE_RING = 0.02
_GOAL_RING = 12
FARTHEST = 2.0
"""No detour leads farther from the straight way than this [m]."""


@dataclass(frozen=True)
class Places:
    """Places (n, 2) to turn at, in the frame of the base at the start; joined (n, n): the way is free."""

    places: FloatArray
    joined: npt.NDArray[np.bool_]


def places_around(passage: Passage, goal: FloatArray, goal_ways: list[float], body: Body) -> Places:
    """Return the places around all things, and around the goal (2,) at distances `goal_ways` [m]."""
    rings = [_ring(goal, way, _GOAL_RING) for way in goal_ways]
    things = passage.things
    for start, end, radius in zip(things.starts, things.ends, things.radii, strict=True):
        for centre in (start, end):
            # The drift is that of the place itself, so a little more than of the thing.
            drift = body.drift_at(float(np.hypot(*centre)) + radius + body.outline.turning_radius)
            way = radius + body.outline.turning_radius + CLEAR + drift + _BESIDE_RING
            rings.append(_ring(centre, way, _ON_RING))
    places = np.concatenate(rings)
    places = places[_can_turn(places, passage, body) & _is_near_way(places, goal)]
    return Places(places, _joined(places, passage, body))


def _ring(centre: FloatArray, radius: float, count: int) -> FloatArray:
    """Return places all around, the first on the line from the start: mirrored worlds have mirrored rings."""
    first = math.atan2(centre[1], centre[0])
    angles = first + np.arange(count) * (2.0 * math.pi / count)
    # From straight ahead a robot drives round: half a step more, so that corners lie aside.
    angles = angles + math.pi / count
    return np.asarray(centre + radius * np.column_stack([np.cos(angles), np.sin(angles)]))


def _is_near_way(places: FloatArray, goal: FloatArray) -> npt.NDArray[np.bool_]:
    origin = np.zeros((1, 2))
    return np.asarray(segment_distances(places, places, origin, goal[None])[:, 0] <= FARTHEST)


def _can_turn(places: FloatArray, passage: Passage, body: Body) -> npt.NDArray[np.bool_]:
    return _free(places, places, places, body.outline.turning_radius, passage)


def _joined(places: FloatArray, passage: Passage, body: Body) -> npt.NDArray[np.bool_]:
    """Tell for each pair whether the base drives free from the one to the other, as a corridor with round
    ends: wider than it really is by what the corners leave free.
    """
    n = len(places)
    starts, ends = np.repeat(places, n, axis=0), np.tile(places, (n, 1))
    ways = ends - starts
    lengths = np.hypot(*ways.T)[:, None]
    along = ways / np.maximum(lengths, 1e-9)
    outline = body.outline
    free = _free(
        starts - outline.rear * along, ends + outline.front * along, ends, outline.half_width, passage
    )
    return np.asarray(free.reshape(n, n) & (lengths > 0.02).reshape(n, n))


def _free(
    starts: FloatArray, ends: FloatArray, reached: FloatArray, radius: float, passage: Passage
) -> npt.NDArray[np.bool_]:
    """Tell for segments (k, 2) to (k, 2) whether all within `radius` of them is free."""
    things = passage.things
    apart = segment_distances(starts, ends, things.starts, things.ends) - things.radii - radius
    needed = np.array([passage.needed_at(place) for place in reached]).reshape(len(reached), -1)
    return np.asarray((apart >= needed).all(axis=1))
