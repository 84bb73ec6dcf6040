"""What became of tapped points that were followed: drift, jumps, losses, honesty of sigma, time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.bench.figure import known
from tapreach.bench.tracking_run import Run
from tapreach.geometry.finite import FloatArray

JUMP = 8.0
JUMP_IN_FIRST = 3.0
"""A jump is farther off than both: [px], and [px of the tapped picture], for what is now seen larger."""
_UNSAID = 4.0
"""A jump that is so many sigma: nothing warned of it."""
_RETURN_AFTER = 3
"""Pictures out of sight that make it gone, and pictures in sight by which it should be found again."""


@dataclass(frozen=True)
class Outcome:
    """Of many runs; None where there is nothing to tell. Shares in percent.

    drift_median, drift_p95: in the last picture where it is visible and not lost [px]; in_first: the same in
    the scale of the tapped picture. normalised: root mean square of error over sigma, jumps left out.
    coverage: share of errors in the 95 % circle of sigma. jumped, jumped_unsaid (4 sigma
    off), lost_at_end, found_again: of the points; lost, unsure: of the pictures where the point is visible.
    """

    points: int
    drift_median: float | None
    drift_p95: float | None
    in_first_median: float | None
    in_first_p95: float | None
    normalised: float | None
    coverage: float | None
    jumped: float | None
    jumped_unsaid: float | None
    lost: float | None
    unsure: float | None
    lost_at_end: float | None
    found_again: float | None
    took_median_ms: float | None
    took_p95_ms: float | None
    took_most_ms: float | None


def outcome_of(runs: Sequence[Run]) -> Outcome:
    """Return the figures of `runs` together."""
    ends = np.array([end for run in runs if (end := _end(run)) is not None]).reshape(-1, 2)
    over_sigma = _joined([_over_sigma(run) for run in runs])
    states = _joined([_states(run) for run in runs])
    took = _joined([run.took_ms for run in runs])
    returned = [found for run in runs if (found := _found_again(run)) is not None]
    return Outcome(
        points=len(runs),
        drift_median=_percentile(ends[:, 0], 50),
        drift_p95=_percentile(ends[:, 0], 95),
        in_first_median=_percentile(ends[:, 1], 50),
        in_first_p95=_percentile(ends[:, 1], 95),
        normalised=known(float(np.sqrt(np.mean(over_sigma**2) / 2.0))) if over_sigma.size else None,
        coverage=_share(over_sigma < 2.4477),
        jumped=_share(np.array([bool(_jumps(run).any()) for run in runs])),
        jumped_unsaid=_share(np.array([bool((_jumps(run) & _is_unsaid(run)).any()) for run in runs])),
        lost=_share(states == 0),
        unsure=_share(states == 1),
        lost_at_end=_share(np.array([_is_lost_at_end(run) for run in runs])),
        found_again=_share(np.array(returned)),
        took_median_ms=_percentile(took, 50),
        took_p95_ms=_percentile(took, 95),
        took_most_ms=_percentile(took, 100),
    )


def errors_of(run: Run) -> FloatArray:
    """Return the distance from the true pixel in each picture (n,) [px], NaN where lost."""
    return np.asarray(np.linalg.norm(run.pixels - run.tapped.pixels[1:], axis=1))


def _scales(run: Run) -> FloatArray:
    return np.asarray(run.tapped.depths[0] / np.maximum(run.tapped.depths[1:], 0.05))


def _jumps(run: Run) -> NDArray[np.bool_]:
    return np.asarray(errors_of(run) > np.maximum(JUMP, JUMP_IN_FIRST * _scales(run)))


def _is_unsaid(run: Run) -> NDArray[np.bool_]:
    return np.asarray(errors_of(run) > _UNSAID * run.sigmas)


def _end(run: Run) -> tuple[float, float] | None:
    errors = errors_of(run)
    (seen,) = np.nonzero(np.isfinite(errors) & run.tapped.is_visible[1:])
    if not seen.size:
        return None
    return float(errors[seen[-1]]), float(errors[seen[-1]] / _scales(run)[seen[-1]])


def _over_sigma(run: Run) -> FloatArray:
    ratios = errors_of(run) / run.sigmas
    return np.asarray(ratios[np.isfinite(ratios) & ~_jumps(run) & run.tapped.is_visible[1:]])


def _states(run: Run) -> FloatArray:
    """Return 0 lost, 1 unsure, 2 sure for each picture where the point is visible."""
    is_seen = np.isfinite(run.pixels[:, 0])
    return np.asarray((is_seen * (1.0 + run.is_sure))[run.tapped.is_visible[1:]])


def _is_lost_at_end(run: Run) -> bool:
    visible = run.tapped.is_visible[1:]
    if not visible.any():
        return False
    return not np.isfinite(run.pixels[np.nonzero(visible)[0][-1], 0])


def _found_again(run: Run) -> bool | None:
    """Tell whether a point that was out of sight and came back is seen again; None where it never did."""
    visible = run.tapped.is_visible[1:]
    hidden = _longest_run_end(~visible)
    if hidden is None or visible[hidden:].sum() < _RETURN_AFTER:
        return None
    back = np.nonzero(visible[hidden:])[0] + hidden
    errors = errors_of(run)[back[_RETURN_AFTER - 1 :]]
    return bool(np.any(errors < JUMP))


def _longest_run_end(mask: NDArray[np.bool_]) -> int | None:
    """Return the index after the first stretch of at least _RETURN_AFTER True values, None without one."""
    length = 0
    for index, value in enumerate(mask):
        if not value and length >= _RETURN_AFTER:
            return index
        length = length + 1 if value else 0
    return None


def _joined(parts: list[FloatArray]) -> FloatArray:
    return np.concatenate(parts) if parts else np.zeros(0)


def _percentile(values: FloatArray, percent: float) -> float | None:
    return float(np.percentile(values, percent)) if values.size else None


def _share(flags: NDArray[np.bool_]) -> float | None:
    return 100.0 * float(np.mean(flags)) if flags.size else None
