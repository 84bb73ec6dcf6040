"""What the widths that a thing shows from several sides tell of its outline on the floor.

A box with sides a, b, one of them at heading psi, is a |sin(phi − psi)| + b |cos(phi − psi)| wide across a
line of sight along phi; something round is as wide from everywhere. Bayes' rule on a grid of both.

Prior: a box or something round with even odds, as large as any from 15 to 400 mm with even odds over the
logarithm, one side of a box longer than the other by a factor of 1.5 (one sigma), any heading. A width
measured is off by Student's t: now and then what stands behind the thing passes for part of it.
"""

import math
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import wrapped

_SMALLEST, _LARGEST, _STEP = 0.015, 0.4, 1.06
"""Sides on the grid [m], each larger than the one before by this factor."""
_GRID_SD = math.log(_STEP) / math.sqrt(12.0)
"""One sigma of what the grid is off by, as a share."""
_LONGER = math.log(1.5)
"""One sigma of the logarithm of one side over the other."""
_HEADINGS = 18
_FREEDOM = 3.0
"""Degrees of freedom of Student's t: one error in seventy is beyond 5 sigmas."""
_SAME_ERROR = math.radians(12.0)
"""Widths seen from sides so near to each other have the same error: together they count as one."""
_ONE_SIGMA = 0.159, 0.5, 0.841
_UNLIKELY = 1e-4
"""Of the best: what has lesser odds is left out."""


@dataclass(frozen=True)
class SeenWidth:
    """A width across the line of sight along `along` [rad, world], with one sigma [m]."""

    along: float
    width: float
    sd: float

    @property
    def sd_on_grid(self) -> float:
        """One sigma, that of the grid included [m]."""
        return math.hypot(self.sd, _GRID_SD * max(self.width, _SMALLEST))


@dataclass(frozen=True, eq=False)
class Footprint:
    """What the outline may be, each (n,): sides [m] and heading [rad, world], is_round: `a` is its diameter.
    odds: of each, their sum is 1.
    """

    a: FloatArray
    b: FloatArray
    heading: FloatArray
    is_round: FloatArray
    odds: FloatArray

    def width(self, along: float) -> tuple[float, float]:
        """Return the median of the width across a direction [rad, world], and one sigma by quantiles [m]."""
        widths = self._widths(along)
        order = np.argsort(widths)
        low, median, high = np.interp(_ONE_SIGMA, np.cumsum(self.odds[order]), widths[order])
        return float(median), float(high - low) / 2.0

    def fits(self, along: float, opening: float) -> float:
        """Return how probable it is no wider than `opening` [m] across a direction [rad, world]."""
        return float(self.odds @ (self._widths(along) <= opening))

    @property
    def round_odds(self) -> float:
        """How probable it is that it is round."""
        return float(self.odds @ self.is_round)

    def best_fit(self, opening: float) -> float:
        """Return `fits` in the direction in which it is greatest."""
        return max(self.fits(along, opening) for along in np.arange(_HEADINGS) * math.pi / _HEADINGS)

    def _widths(self, along: float) -> FloatArray:
        aside = along - self.heading
        as_box = self.a * np.abs(np.sin(aside)) + self.b * np.abs(np.cos(aside))
        return np.where(self.is_round, self.a, as_box)

    def _likely(self) -> "Footprint":
        kept = self.odds > _UNLIKELY * self.odds.max()
        odds = self.odds[kept] / self.odds[kept].sum()
        return Footprint(self.a[kept], self.b[kept], self.heading[kept], self.is_round[kept], odds)


def aside_of(along: float, other: float) -> float:
    """Return the angle between two directions across which a width is seen [rad]; opposite ones are alike."""
    return abs(wrapped(2.0 * (along - other))) / 2.0


@lru_cache(maxsize=64)
def footprint(seen: tuple[SeenWidth, ...]) -> Footprint:
    """Return what the outline may be after these widths; what any thing may be after none."""
    prior = _prior()
    log_odds = np.log(prior.odds)
    for one in seen:
        off = (prior._widths(one.along) - one.width) / one.sd_on_grid
        log_likelihood = -0.5 * (_FREEDOM + 1.0) * np.log1p(off**2 / _FREEDOM)
        log_odds += log_likelihood * _share(one, seen)
    odds = np.exp(log_odds - log_odds.max())
    return Footprint(prior.a, prior.b, prior.heading, prior.is_round, odds / odds.sum())._likely()


def _share(one: SeenWidth, seen: tuple[SeenWidth, ...]) -> float:
    """Return for how much a width counts among those with its error, the surer the more; opposite sides show
    the same.
    """
    asides = [aside_of(one.along, other.along) for other in seen]
    alike = [math.exp(-0.5 * (aside / _SAME_ERROR) ** 2) for aside in asides]
    return 1.0 / sum(
        each * (one.sd_on_grid / other.sd_on_grid) ** 2 for each, other in zip(alike, seen, strict=True)
    )


@cache
def _prior() -> Footprint:
    count = 1 + int(math.log(_LARGEST / _SMALLEST) / math.log(_STEP))
    sides = _SMALLEST * _STEP ** np.arange(count)
    headings = np.arange(_HEADINGS) * math.pi / (2 * _HEADINGS)
    a, b, heading = (each.ravel() for each in np.meshgrid(sides, sides, headings, indexing="ij"))
    boxes, rounds = np.zeros(len(a)), np.ones(count)
    nothing = np.zeros(count)
    as_box = np.exp(-0.5 * (np.log(a / b) / _LONGER) ** 2)
    odds = np.concatenate([0.5 * as_box / as_box.sum(), np.full(count, 0.5 / count)])
    return Footprint(
        np.concatenate([a, sides]),
        np.concatenate([b, sides]),
        np.concatenate([heading, nothing]),
        np.concatenate([boxes, rounds]).astype(bool),
        odds,
    )
