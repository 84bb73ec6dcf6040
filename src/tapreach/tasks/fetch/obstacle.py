"""Known things as the way must keep clear of them: where each may stand, seen from above."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.geometry.convex import distances_from_polygon
from tapreach.geometry.finite import FloatArray, finite_array, not_negative
from tapreach.geometry.gaussian import confidence_ellipse, require_covariance
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.thing import Thing, ThingSize
from tapreach.tasks.target import Target

UNKNOWN_RADIUS = 0.06
"""A thing of unknown size is taken to be as large as what a small robot fetches, and a hand more [m]."""
_SURE = 2.0
"""Sizes are taken this many sigmas larger."""


@dataclass(frozen=True)
class Obstacle:
    """All that is within `radius` [m] of the line from `start` to `end`, (2,) each on the floor [m].

    radius: half across the thing, corners included; kept apart from `spread`, the further way all around by
    which its place is unknown [m]. The line is there since a thing's distance is known worse than its
    bearing. name: what people call it.
    """

    name: str
    start: FloatArray
    end: FloatArray
    radius: float
    spread: float

    @classmethod
    def around(cls, name: str, centre: npt.ArrayLike, covariance: npt.ArrayLike, radius: float) -> "Obstacle":
        """Return the thing of `radius` at (2,), anywhere in the 95 % region of its covariance (2, 2).

        The ellipse with half axes a ≥ b lies within b of the inner a − b of its long axis to both sides.
        Raises InputError for values that are not finite, and for what is no covariance.
        """
        middle = finite_array(f"centre of {name}", centre, (2,))
        region = confidence_ellipse(require_covariance(f"covariance of {name}", covariance, 2))
        long, short = (float(axis) for axis in region.half_axes)
        reach = (long - short) * region.directions[:, 0]
        return cls(name, middle - reach, middle + reach, not_negative("radius", radius), short)

    @classmethod
    def of_thing(cls, name: str, thing: Thing) -> "Obstacle":
        """Return the room that a thing takes; taken as square where its size is known."""
        if not isinstance(thing.size, ThingSize):
            cov = np.asarray(thing.point_cov_in_world)[:2, :2]
            return cls.around(name, thing.point_in_world[:2], cov, UNKNOWN_RADIUS)
        size = thing.size
        radius = (size.width + _SURE * size.width_sd) / math.sqrt(2.0)
        return cls.around(name, size.axis_in_world[:2], np.asarray(size.axis_cov_in_world)[:2, :2], radius)

    @classmethod
    def of_target(cls, target: Target) -> "Obstacle | None":
        """Return the room that a target of the page takes; None where it has no position yet."""
        point, covariance = target.point_in_world, target.point_cov_in_world
        if point is None or covariance is None:
            return None
        size = target.extent.size if target.extent is not None else None
        known = UNKNOWN_RADIUS if size is None else (size.width + _SURE * size.width_sd) / math.sqrt(2.0)
        return cls.around(f"target {target.target_id}", point[:2], covariance[:2, :2], known)

    @property
    def centre(self) -> FloatArray:
        """(2,) [m]"""
        return np.asarray((self.start + self.end) / 2.0)

    def seen_from(self, world_from_base: PlanarPose) -> "Obstacle":
        """Return it in the frame of `world_from_base`."""
        ends = into(world_from_base, np.array([self.start, self.end]))
        return Obstacle(self.name, ends[0], ends[1], self.radius, self.spread)

    def may_be_at(self, place: FloatArray, within: float) -> bool:
        """Tell whether its middle may lie within `within` [m] of a place (2,)."""
        apart = distances_from_polygon(place[None], self.start[None], self.end[None])
        return bool(apart[0] <= within + self.spread)


@dataclass(frozen=True)
class Surroundings:
    """Several obstacles, ready to be asked together: starts, ends (m, 2), radii (m,) with their spread."""

    obstacles: tuple[Obstacle, ...]
    starts: FloatArray
    ends: FloatArray
    radii: FloatArray

    @classmethod
    def of(cls, obstacles: Sequence[Obstacle]) -> "Surroundings":
        """Return them together; there may be none."""
        starts = np.array([each.start for each in obstacles]).reshape(-1, 2)
        ends = np.array([each.end for each in obstacles]).reshape(-1, 2)
        radii = np.array([each.radius + each.spread for each in obstacles])
        return cls(tuple(obstacles), starts, ends, radii)

    def clearances(self, polygon: FloatArray) -> FloatArray:
        """Return (m,): the way between each and a convex polygon (k, 2) [m]; below 0 where it overlaps."""
        return distances_from_polygon(polygon, self.starts, self.ends) - self.radii


def into(world_from_base: PlanarPose, points: FloatArray) -> FloatArray:
    """Return points (n, 2) of the world in the frame of `world_from_base`."""
    c, s = math.cos(world_from_base.heading), math.sin(world_from_base.heading)
    off = points - [world_from_base.x, world_from_base.y]
    return np.asarray(off @ np.array([[c, -s], [s, c]]))


def out_of(world_from_base: PlanarPose, points: FloatArray) -> FloatArray:
    """Return points (n, 2) of the frame of `world_from_base` in the world."""
    c, s = math.cos(world_from_base.heading), math.sin(world_from_base.heading)
    return np.asarray(points @ np.array([[c, s], [-s, c]]) + [world_from_base.x, world_from_base.y])
