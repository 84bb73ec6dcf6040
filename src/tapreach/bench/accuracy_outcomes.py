"""What the estimator answered in many trials, held against the truth."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_trials import Trials
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import Motion
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.estimation.tap_noise import TapNoise
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.gaussian import chi2_limit

REGION_95 = chi2_limit(0.95, 3)


@dataclass(frozen=True)
class Outcomes:
    """Of m trials. errors (m, 3): bearing and inverse depth less the truth; nees (m,): their squares in units
    of the covariance. nearest, farthest (m,) [m]: ends of the 95 % interval, farthest infinite when open;
    ranges (m,): the truth. NaN where there was no answer. rejected (m, n): views that were left out.
    """

    errors: FloatArray
    nees: FloatArray
    nearest: FloatArray
    farthest: FloatArray
    ranges: FloatArray
    rejected: npt.NDArray[np.bool_]

    @property
    def is_answered(self) -> npt.NDArray[np.bool_]:
        """(m,) True where there is an inverse depth with a covariance."""
        return np.isfinite(self.nees)

    @property
    def has_interval(self) -> npt.NDArray[np.bool_]:
        """(m,) True where a range interval was given."""
        return np.isfinite(self.nearest)

    @property
    def is_range_held(self) -> npt.NDArray[np.bool_]:
        """(m,) True where an interval was given and holds the truth."""
        return np.asarray((self.nearest <= self.ranges) & (self.ranges <= self.farthest))

    def first(self, count: int) -> "Outcomes":
        """Return the first trials only."""
        return Outcomes(*(getattr(self, each.name)[:count] for each in fields(self)))

    def region_coverage(self) -> float:
        """Return the share of answers whose 95 % region holds the truth."""
        return mean_or_nan(self.nees[self.is_answered] <= REGION_95)

    def interval_coverage(self) -> float:
        """Return the share of range intervals that hold the truth."""
        return mean_or_nan(self.is_range_held[self.has_interval])

    def consistency(self) -> float:
        """Return NEES/3: 1 where the covariance is what the errors are."""
        return mean_or_nan(self.nees[self.is_answered]) / 3.0

    def error_over(self, sd: float | FloatArray) -> float:
        """Return the root mean square error of the inverse depth over `sd` [1/m], one or (m,)."""
        return math.sqrt(mean_or_nan(((self.errors[:, 2] / sd) ** 2)[self.is_answered]))


def mean_or_nan(values: npt.NDArray[Any]) -> float:
    """Return the mean, NaN of nothing."""
    return float(values.mean()) if len(values) else math.nan


def estimate_all(trials: Trials, motion: Motion, tap_noise: TapNoise | None = None) -> Outcomes:
    """Estimate every trial and score it."""
    estimate = partial(estimate_point, motion=motion, tap_noise=tap_noise, with_advice=False)
    estimates = [estimate(views) for views in trials.sightings()]
    return score(trials, estimates)


def score(trials: Trials, estimates: Sequence[PointEstimate]) -> Outcomes:
    """Hold the estimates against the truth."""
    errors = np.full((len(estimates), 3), np.nan)
    nees = np.full(len(estimates), np.nan)
    ends = np.full((len(estimates), 2), np.nan)
    rejected = np.zeros(trials.pixels.shape[:2], dtype=bool)
    for i, estimate in enumerate(estimates):
        rejected[i, list(estimate.rejected_views)] = True
        covariance, rho = estimate.bearing_inverse_depth_cov, estimate.inverse_depth
        if estimate.bearing is not None and rho is not None and covariance is not None:
            errors[i] = np.append(estimate.bearing, rho) - trials.targets[i]
            nees[i] = errors[i] @ np.linalg.solve(covariance, errors[i])
        if estimate.range_interval_95 is not None:
            near, far = estimate.range_interval_95
            ends[i] = near, np.inf if far is None else far
    return Outcomes(errors, nees, ends[:, 0], ends[:, 1], trials.ranges, rejected)


def joined(parts: Sequence[Outcomes]) -> Outcomes:
    """Return the trials of all parts as one; the rejected views are kept where all have the same number."""
    views = {part.rejected.shape[1] for part in parts}
    rejected = [part.rejected if len(views) == 1 else np.zeros((len(part.nees), 0), bool) for part in parts]
    return Outcomes(
        np.concatenate([part.errors for part in parts]),
        np.concatenate([part.nees for part in parts]),
        np.concatenate([part.nearest for part in parts]),
        np.concatenate([part.farthest for part in parts]),
        np.concatenate([part.ranges for part in parts]),
        np.concatenate(rejected),
    )
