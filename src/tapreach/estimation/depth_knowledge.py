"""What the views tell about the depth: its spread, whether they tell anything, and the range interval."""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.estimation.map_solver import Solution, inverse_depth_information
from tapreach.estimation.range_posterior import RangePosterior, RangePrior, range_posterior
from tapreach.estimation.view_model import ViewModel
from tapreach.geometry.finite import FloatArray

_NORMAL = 0.05  # relative sd up to which the inverse depth, and so the range, may be called normal
_TWO_SIDED_95 = 1.96


@dataclass(frozen=True)
class DepthKnowledge:
    """inverse_depth 1/Z [1/m] and its sd in the first camera; slant: range over Z of the target's ray.

    baseline [m]: the greatest distance between two cameras. posterior: over the range, where needed.
    least_sd: the larger of sd and the sd for a target at infinity, which noise cannot have made look near.
    """

    inverse_depth: float
    sd: float
    least_sd: float
    slant: float
    baseline: float
    posterior: RangePosterior | None

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

    def likely_range(self) -> float:
        """Return a range [m] to plan with, also where it is open."""
        if self.posterior is not None:
            return self.posterior.quantile(0.5)
        return self.slant / self.inverse_depth if self.inverse_depth > 0.0 else 20.0 * self.baseline

    def range_interval(self) -> tuple[float, float | None] | None:
        """Return the central 95 % interval of the range [m]; with an open far end, the 95 % lower limit."""
        if self.posterior is None:
            if self.relative_sd > _NORMAL:
                return None
            margin = _TWO_SIDED_95 * self.sd
            return self.slant / (self.inverse_depth + margin), self.slant / (self.inverse_depth - margin)
        if self.is_open_far:
            return self.posterior.quantile(0.05), None
        return self.posterior.quantile(0.025), self.posterior.quantile(0.975)


def depth_knowledge(model: ViewModel, solution: Solution, prior: RangePrior) -> DepthKnowledge:
    """Return what the solution tells about the depth; the posterior only where 1/Z is not nearly normal."""
    sd = _sd(solution.on_target)
    slant = float(np.linalg.norm([*solution.x[:2], 1.0]))
    rho = solution.inverse_depth
    is_normal = rho > 0.0 and sd <= _NORMAL * rho
    posterior = None if is_normal or math.isinf(sd) else range_posterior(model, solution, prior)
    at_infinity = model.linearised(model.on_ray(np.zeros(1)))
    least_sd = max(sd, _sd(at_infinity.on_target()[0])) if at_infinity.is_in_front[0] else sd
    return DepthKnowledge(rho, sd, least_sd, slant, model.baseline, posterior)


def _sd(on_target: FloatArray) -> float:
    on_depth = inverse_depth_information(on_target)
    # Compared with what the depth would have if all else were known: below that it is rounding.
    return 1.0 / math.sqrt(on_depth) if on_depth > 1e-12 * on_target[2, 2] else math.inf
