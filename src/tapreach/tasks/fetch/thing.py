"""What is to be fetched, as far as it is known."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tapreach.estimation.footprint import Footprint, SeenWidth, aside_of, footprint
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, wrapped

SAME_SIDE = math.radians(15.0)
"""A thing seen from farther aside than this shows another width."""
_LOOK_SD = 0.1
"""One sigma of a width of which both sides are seen, at most; where less is known it is a lower limit."""


_POST_WIDTH, _POST_HEIGHT = 0.1, 0.27
"""So high, two sigmas at least, and so narrow [m] is the leg of a piece of furniture, or an edge."""


@dataclass(frozen=True)
class ThingSize:
    """How large the thing is and where its middle is.

    width: across the line of sight, height: foot to top [m], with one sigma each. foot: height of its lowest
    point above the floor [m]. axis_in_world (3,): its middle, half a depth behind its front, at half its
    height [m]; axis_cov_in_world (3, 3) [m²]. caveat: what to know of it, '' for nothing. seen_along:
    direction in the world of the line of sight across which the width was measured [rad]; None stands for
    that from where the base is. goes_on_above: its upper end was not found; `height` is as far as was looked.
    by_picture: the outline was found, not drawn by somebody. told: how often it was measured so, each time
    from elsewhere. seen: the widths by all looks, from whatever side. is_doubted: the newest measurement from
    this side contradicts it, and neither is confirmed yet. denied: how often no sides of it were found since,
    each time from elsewhere. is_cut_above: by the picture's edge; it is at least so high.
    """

    width: float
    width_sd: float
    height: float
    height_sd: float
    foot: float
    axis_in_world: FloatArray
    axis_cov_in_world: FloatArray
    caveat: str = ""
    seen_along: float | None = None
    by_picture: bool = False
    told: int = 1
    goes_on_above: bool = False
    seen: tuple[SeenWidth, ...] = ()
    is_doubted: bool = False
    denied: int = 0
    is_cut_above: bool = False

    @property
    def is_post(self) -> bool:
        """True for what is so high by its outline as nothing that a claw can get around stands by itself."""
        return (
            self.by_picture and self.width < _POST_WIDTH and self.height - 2.0 * self.height_sd > _POST_HEIGHT
        )

    @property
    def is_unconfirmed(self) -> bool:
        """True where it was measured, or contradicted, only once, and more than one look since denies it."""
        return self.is_doubted or (self.told == 1 and self.denied > 1)

    @property
    def footprint(self) -> Footprint:
        """What its outline on the floor may be, by the widths from all sides."""
        return footprint(self.seen or (self.look_along(self.seen_along or 0.0),))

    def look_along(self, along: float) -> SeenWidth:
        """Return the width as what a look along a direction in the world [rad] tells of the outline."""
        return SeenWidth(along, self.width, min(self.width_sd, _LOOK_SD * self.width))

    def at_least_as_high_as(self, known: "ThingSize") -> "ThingSize":
        """Return it with the height that is known, where its own is only as far as the picture reaches."""
        if not self.is_cut_above or known.height <= self.height:
            return self
        return replace(
            self,
            height=known.height,
            height_sd=known.height_sd,
            is_cut_above=known.is_cut_above,
            axis_in_world=np.array([*self.axis_in_world[:2], self.foot + known.height / 2.0]),
        )

    def across(self, along: float) -> "ThingSize":
        """Return the size across the direction `along` in the world [rad]: as measured where it was from
        there, else as all widths together tell it.
        """
        if self.seen_along is not None and abs(wrapped(along - self.seen_along)) <= SAME_SIDE:
            return self
        width, width_sd = self.footprint.width(along)
        return replace(self, width=width, width_sd=width_sd, seen_along=along)

    def aside_of_looks(self, along: float) -> float:
        """Return how far a direction in the world is from the nearest across which it was measured [rad];
        opposite sides show the same.
        """
        looks = [look.along for look in self.seen] or [self.seen_along or 0.0]
        return min(aside_of(along, look) for look in looks)

    def fits(self, opening: float) -> float:
        """Return how probable it is that it is no wider than `opening` [m] across this sight."""
        return self.footprint.fits(self.seen_along or 0.0, opening)

    def seen_from(self, base: PlanarPose) -> "ThingSize":
        """Return the size with `seen_along` told, where that is from `base`."""
        if self.seen_along is not None:
            return self
        return replace(self, seen_along=self.sight_from(base))

    def sight_from(self, base: PlanarPose) -> float:
        """Return the direction in the world of the line of sight from a base to its middle [rad]."""
        return math.atan2(self.axis_in_world[1] - base.y, self.axis_in_world[0] - base.x)


@dataclass(frozen=True)
class NoSize:
    """Why the size cannot be told, in words a person can act on.

    by_one_view: what the view from nearest tells of it, where that is an outline with both sides; one alone
    is often wrong. denies_sides: left or right no side of its own is seen, though it is in the picture.
    """

    reason: str
    by_one_view: ThingSize | None = None
    denies_sides: bool = False


@dataclass(frozen=True)
class Thing:
    """A located thing in the world of the present odometry: the tapped place (3,) [m] with its covariance
    (3, 3) [m²], and its size.
    """

    point_in_world: FloatArray
    point_cov_in_world: FloatArray
    size: ThingSize | NoSize

    @property
    def place_sd(self) -> float:
        """One sigma of its place on the floor [m], along the direction in which it is known worst."""
        return math.sqrt(max(0.0, float(np.linalg.eigvalsh(self.point_cov_in_world[:2, :2])[-1])))
