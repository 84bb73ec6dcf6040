"""How far the target may be, where a single number would lie: a posterior over the range.

Everything but the inverse depth is profiled out, with Laplace's term for the width of what was profiled
(docs/estimation.md, 9). Where the range is well determined this agrees with the normal approximation.
"""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.estimation.gauss_newton import descended
from tapreach.estimation.map_solver import Solution, inverse_depth_information
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray, not_negative

_GRID = 32
_TOLERANCE = 1e-3  # of the squared residuals; the posterior does not show less
_OPEN_BELOW = 3.84  # chi-square, one degree of freedom, 95 %


@dataclass(frozen=True)
class RangePrior:
    """Ranges [m] that are possible at all, and how the odds over their logarithm go: as range^-falloff.

    falloff 1: even odds over the inverse range, for which intervals hold any true range equally often;
    0: even odds over the logarithm (docs/estimation.md, 9a). Raises InputError for what cannot be.
    """

    nearest: float = 0.05
    farthest: float = 100.0
    falloff: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 < self.nearest < self.farthest < float("inf"):
            raise InputError(
                f"range prior is {self.nearest} to {self.farthest} m; give 0 < nearest < farthest"
            )
        object.__setattr__(self, "falloff", not_negative("falloff", self.falloff))


@dataclass(frozen=True)
class RangePosterior:
    """Grid of ranges [m] with their probability, and what can be said of the ends.

    is_open_far: the farthest range is not worse than the best by more than chance (95 %).
    """

    ranges: FloatArray
    probabilities: FloatArray
    is_open_far: bool

    def quantile(self, probability: float) -> float:
        """Return the range [m] below which the target lies with `probability`."""
        logs = np.log(self.ranges)
        below = np.concatenate([[0.0], np.cumsum(self.probabilities)])
        edges = np.concatenate([[logs[0]], (logs[1:] + logs[:-1]) / 2.0, [logs[-1]]])
        return float(np.exp(np.interp(probability, below, edges)))

    def interval(self, low: float, high: float) -> tuple[float, float]:
        """Return the ranges [m] below which the target lies with probability `low` and `high`."""
        return self.quantile(low), self.quantile(high)


def range_posterior(model: ViewModel, best: Solution, prior: RangePrior) -> RangePosterior | None:
    """Return the posterior over the range from the first camera; None where no range at all is feasible."""
    ranges = _grid(model, best, prior)
    costs, widths = _profile(model, best, ranges)
    if not np.any(np.isfinite(costs)):
        return None
    odds = ranges**-prior.falloff * np.gradient(np.log(ranges))
    weights = np.exp(-0.5 * (costs - costs.min())) * widths * odds
    open_far = bool(costs[-1] - costs.min() < _OPEN_BELOW)
    return RangePosterior(ranges, weights / weights.sum(), open_far)


def _grid(model: ViewModel, best: Solution, prior: RangePrior) -> FloatArray:
    """Spread ranges evenly in logarithm over the prior, and as many more about the minimum."""
    everywhere = np.geomspace(prior.nearest, prior.farthest, _GRID)
    slant = float(np.linalg.norm([*best.x[:2], 1.0]))
    rho = best.inverse_depth
    sd = 1.0 / math.sqrt(max(inverse_depth_information(best.on_target), 1e-24))
    near_minimum = rho + sd * np.linspace(-4.0, 4.0, _GRID // 2)
    ranges = slant / near_minimum[near_minimum > 0.0]
    inside = ranges[(ranges > prior.nearest) & (ranges < prior.farthest)]
    return np.unique(np.concatenate([everywhere, inside]))


def _profile(model: ViewModel, best: Solution, ranges: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least cost at each range, and the volume of what was profiled out (up to a factor)."""
    starts = np.repeat(best.x[None], len(ranges), axis=0)
    starts[:, 2] = float(np.linalg.norm([*best.x[:2], 1.0])) / ranges
    found = descended(model, starts, is_depth_free=False, tolerance=_TOLERANCE)
    costs = found.costs
    feasible = np.isfinite(costs)
    log_widths = np.full(len(ranges), -np.inf)
    log_widths[feasible] = -0.5 * found.take(feasible).log_information_without_depth()
    highest = log_widths.max()
    # No range at all may be feasible; the caller sees it by the costs.
    return costs, np.exp(log_widths - (highest if np.isfinite(highest) else 0.0))
