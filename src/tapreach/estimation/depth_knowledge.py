"""What the views tell about the depth: its spread, whether they tell anything, and the range interval."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tapreach.estimation.map_solver import Solution, inverse_depth_information
from tapreach.estimation.near_normal import UP_TO, NearNormalPosterior
from tapreach.estimation.range_posterior import RangePosterior, RangePrior, range_posterior
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_PLAIN_PARALLAX = 0.02  # sd times baseline; then noise cannot have made a target at infinity look near
_BEYOND_CHANCE = 3.0  # sigmas of 1/Z
_ALIKE = 2.0  # ... where no depth in one camera is more than this many times that in another


@dataclass(frozen=True)
class DepthKnowledge:
    """inverse_depth 1/Z [1/m] and its sd in the first camera; slant: range over Z of the target's ray.

    least_sd: the larger of sd and the sd for a target at infinity, which noise cannot have made look near.
    """

    model: ViewModel
    solution: Solution
    prior: RangePrior
    inverse_depth: float
    sd: float
    least_sd: float
    slant: float

    @property
    def baseline(self) -> float:
        """The greatest distance between two cameras [m]."""
        return self.model.baseline

    @cached_property
    def posterior(self) -> RangePosterior | NearNormalPosterior | None:
        """Over the range, computed when first asked for; None where 1/Z is not known at all."""
        if self.inverse_depth > 0.0 and self.sd <= UP_TO * self.inverse_depth:
            return NearNormalPosterior(self.inverse_depth, self.sd, self.slant, self.prior)
        return None if math.isinf(self.sd) else range_posterior(self.model, self.solution, self.prior)

    @property
    def relative_sd(self) -> float:
        """sd(1/Z)·Z; infinite where the depth is open or unknown."""
        return self.sd / self.inverse_depth if self.inverse_depth > 0.0 else math.inf

    @property
    def lost_parallax(self) -> float:
        """sd(1/Z)·baseline: one over the number of baselines up to which a depth could be told at all."""
        return self.least_sd * self.baseline

    @property
    def is_open_far(self) -> bool:
        """True where the target may as well be at infinity."""
        return self.inverse_depth <= 0.0 or (self.posterior is not None and self.posterior.is_open_far)

    @property
    def is_nearer_than_possible(self) -> bool:
        """True where the target would be nearer than the nearest range there is, by more than chance."""
        return self.inverse_depth - _BEYOND_CHANCE * self.sd > self.slant / self.prior.nearest

    @property
    def is_behind_as_given(self) -> bool:
        """True where the target would be behind a camera used, were the poses without errors."""
        return bool(np.any(self.model.depths(self.solution.x[:3])[self.model.is_used] <= 0.0))

    def likely_range(self) -> float:
        """Return a range [m] to plan with, also where it is open."""
        if self.posterior is not None:
            return self.posterior.quantile(0.5)
        return self.slant / self.inverse_depth if self.inverse_depth > 0.0 else 20.0 * self.baseline

    def range_interval(self) -> tuple[float, float | None] | None:
        """Return the central 95 % interval of the range [m]; with an open far end, the 95 % lower limit."""
        if self.posterior is None:
            return None
        if self.is_open_far:
            return self.posterior.quantile(0.05), None
        return self.posterior.interval(0.025, 0.975)


def depth_knowledge(model: ViewModel, solution: Solution, prior: RangePrior) -> DepthKnowledge:
    """Return what the solution tells of the depth; the whole profile only where 1/Z is not nearly normal."""
    sd = _sd(solution.on_target)
    slant = math.hypot(*solution.x[:2].tolist(), 1.0)
    least_sd = _least_sd(model, solution, sd)
    return DepthKnowledge(model, solution, prior, solution.inverse_depth, sd, least_sd, slant)


def _least_sd(model: ViewModel, solution: Solution, sd: float) -> float:
    """Return the larger of sd and that for a target at infinity, which is left out where plainly small."""
    if solution.inverse_depth > 0.0 and sd * model.baseline < _PLAIN_PARALLAX:
        depths = model.depths(solution.x[:3])
        if depths.max() < _ALIKE * depths.min():
            return sd
    at_infinity = model.linearised(model.on_ray(np.zeros(1)))
    return max(sd, _sd(at_infinity.on_target()[0])) if at_infinity.is_in_front[0] else sd


def _sd(on_target: FloatArray) -> float:
    on_depth = inverse_depth_information(on_target)
    # Compared with what the depth would have if all else were known: below that it is rounding.
    return 1.0 / math.sqrt(on_depth) if on_depth > 1e-12 * on_target[2, 2] else math.inf
