"""What the estimator answers: always a status and a reason, and a point where there is one."""

from dataclasses import dataclass, field
from enum import StrEnum

from tapreach.estimation.point_in_frames import GivenInFrames, TargetInFrames
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
    range: distance from the first camera [m]; range_interval_95: its central 95 % interval, whose far end is
    None when open. None where nothing can be said.
    residuals_px (n, 2): predicted minus observed, of all views, rejected ones included.
    rejected_views: indices of observations that do not fit the others and were left out.
    in_frames: what the points below are computed from, when first asked for. Their covariances (3, 3) [m²]
    are first-order, fair where `is_ellipsoid_fair`. None unless determined.
    """

    status: Status
    reason: str
    advice: str
    bearing: FloatArray | None
    inverse_depth: float | None
    bearing_inverse_depth_cov: FloatArray | None
    relative_sd: float
    range: float | None
    range_interval_95: tuple[float, float | None] | None
    residuals_px: FloatArray
    rejected_views: tuple[int, ...]
    in_frames: TargetInFrames | GivenInFrames | None = field(repr=False, compare=False)

    @property
    def point_in_world(self) -> FloatArray | None:
        """The target (3,) [m] in the frame of the poses given, which is fixed to the first of them."""
        return self.in_frames.world.point if self.in_frames is not None else None

    @property
    def point_cov_in_world(self) -> FloatArray | None:
        """Its covariance (3, 3) [m²]."""
        return self.in_frames.world.covariance if self.in_frames is not None else None

    @property
    def point_in_base(self) -> FloatArray | None:
        """The target (3,) [m] in the base frame of the last observation."""
        return self.in_frames.base.point if self.in_frames is not None else None

    @property
    def point_cov_in_base(self) -> FloatArray | None:
        """Its covariance (3, 3) [m²]."""
        return self.in_frames.base.covariance if self.in_frames is not None else None

    @property
    def is_ellipsoid_fair(self) -> bool:
        """True where the covariances of the points describe the region well (relative_sd up to 0.05)."""
        return self.in_frames is not None and self.relative_sd <= 0.05
