"""Whether a solution is an answer, and if not, why not, in words a person can act on."""

from functools import lru_cache

from scipy.special import stdtrit

from tapreach.estimation.depth_knowledge import DepthKnowledge
from tapreach.estimation.map_solver import Solution
from tapreach.estimation.point_estimate import Status
from tapreach.estimation.view_model import ViewModel

_LOST_PARALLAX = 0.3  # then not even a target 3 baselines away can be told from one at infinity
_DIVERGING = -3.0  # sigmas of 1/Z below zero
_TAIL = 4.0  # degrees of freedom of Student's t: real taps have heavier tails than normal
_CONTRADICTION = 0.001  # odds of such residuals by chance
_SHORT_BASELINE = 1e-6  # [m]; a camera that moved less has only turned


def verdict(model: ViewModel, solution: Solution, depth: DepthKnowledge) -> tuple[Status, str]:
    """Return the status of a solution and its reason."""
    freedom = 2 * model.used - 3
    is_contradictory = solution.cost > _heavy_tailed_limit(max(freedom, 1))
    diverging = is_contradictory or depth.inverse_depth < _DIVERGING * depth.sd
    if depth.inverse_depth < 0.0 and diverging:
        return Status.BEHIND, "the lines of sight diverge: they would meet behind the camera"
    if is_contradictory:
        return Status.INCONSISTENT, (
            f"the {model.used} views contradict each other: squared residuals "
            f"{solution.cost:.0f} where about {freedom} is right; "
            f"was the same thing tapped, and did it stand still?"
        )
    if depth.lost_parallax > _LOST_PARALLAX:
        return Status.DEGENERATE, (
            f"too little parallax: the camera moved {100.0 * depth.baseline:.0f} cm, almost along the line "
            f"of sight or by less than the errors of tap and odometry can show"
        )
    if depth.is_nearer_than_possible:
        met_cm, nearest_cm = 100.0 * depth.slant / depth.inverse_depth, 100.0 * depth.prior.nearest
        return Status.INCONSISTENT, (
            f"the lines of sight meet {met_cm:.2g} cm from the camera, where nothing can be nearer than "
            f"{nearest_cm:.2g} cm; was the same thing tapped?"
        )
    if depth.is_open_far:
        return Status.RANGE_BOUNDED_BELOW, "the target may be at any range from the lower limit on"
    if depth.is_behind_as_given:
        return Status.INCONSISTENT, "the target would be nearer to a camera than the poses are known"
    return Status.DETERMINED, f"range known to {100.0 * depth.relative_sd:.2g} % (one sigma)"


@lru_cache(maxsize=256)
def _heavy_tailed_limit(freedom: int) -> float:
    """Return what the squared residuals exceed by chance when taps have heavy tails, equation (9).

    Large sums of heavy-tailed terms are large by one of them. Source: Embrechts, Klüppelberg and Mikosch,
    Modelling Extremal Events, 1.3 (subexponential distributions).
    """
    largest = float(stdtrit(_TAIL, 1.0 - 0.5 * _CONTRADICTION / freedom))
    return (_TAIL - 2.0) / _TAIL * largest**2 + freedom - 1.0


def reason_without_baseline(model: ViewModel) -> str | None:
    """Return why there is no depth at all, where the camera did not move; else None."""
    if model.views == 1:
        return "one view gives a direction and no depth; move and look again"
    if model.baseline < _SHORT_BASELINE:
        return "the camera only turned about its own centre, which gives no depth; drive some way"
    return None
