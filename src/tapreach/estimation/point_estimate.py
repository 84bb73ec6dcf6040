"""What the estimator answers: always a status and a reason, and a point where there is one."""

from dataclasses import dataclass
from enum import StrEnum

from tapreach.geometry.finite import FloatArray


class Status(StrEnum):
    """determined: the range has two ends. range_bounded_below: at least so far. degenerate: the motion cannot
    tell. behind: the rays diverge. inconsistent: the views contradict each other.
    """

    DETERMINED = "determined"
    RANGE_BOUNDED_BELOW = "range_bounded_below"
    DEGENERATE = "degenerate"
    BEHIND = "behind"
    INCONSISTENT = "inconsistent"


@dataclass(frozen=True)
class PointEstimate:
    """Where the target is, and how sure that is.

    bearing (2,): (X/Z, Y/Z) in the camera of the first observation; inverse_depth: 1/Z there [1/m]; their
    covariance (3, 3) in this order, most nearly normal here and not in x, y, z. None where degenerate.
    relative_sd: sd(1/Z)·Z, the measure of degeneracy; infinite where nothing is known.
    point_in_world, point_in_base (3,) [m]: the latter in the base frame of the last observation. The world is
    the frame of the poses given, fixed to the first of them. Their covariances (3, 3) [m²] are first-order,
    fair where `is_ellipsoid_fair`. None unless determined.
    range: distance from the first camera [m]; range_interval_95: its central 95 % interval, whose far end is
    None when open. None where nothing can be said.
    residuals_px (n, 2): predicted minus observed, of all views, rejected ones included.
    rejected_views: indices of observations that do not fit the others and were left out.
    """

    status: Status
    reason: str
    advice: str
    bearing: FloatArray | None
    inverse_depth: float | None
    bearing_inverse_depth_cov: FloatArray | None
    relative_sd: float
    point_in_world: FloatArray | None
    point_cov_in_world: FloatArray | None
    point_in_base: FloatArray | None
    point_cov_in_base: FloatArray | None
    range: float | None
    range_interval_95: tuple[float, float | None] | None
    residuals_px: FloatArray
    rejected_views: tuple[int, ...]

    @property
    def is_ellipsoid_fair(self) -> bool:
        """True where the covariances of the points describe the region well (relative_sd up to 0.05)."""
        return self.point_in_world is not None and self.relative_sd <= 0.05
