"""A place carried along by what moves around it, and a patch's own word joined with that.

A patch without texture in some direction says nothing there; its surroundings do. Both err by the same from
picture to picture, so that joining them never makes the place surer than the better of the two.
"""

from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.vision.flow import Motion
from tapreach.vision.look import Fit
from tapreach.vision.warp import Warp, calmed, chained

_STEP_SIGMA = 0.03
"""What following corners for one picture adds at least [px]."""
_LAYER_SHARE = 0.3
"""Share of the corners' disagreement by which the place may differ from them, picture after picture alike."""
_CONFLICT = 16.0
"""Squared distance of the patch from where it was carried that is more than chance: four sigma."""


@dataclass(frozen=True, eq=False)
class Start:
    """Where a place is expected: warp, and covariance (2, 2) [px²] of its centre, None for unknown."""

    warp: Warp
    covariance: FloatArray | None


def carried(motions: tuple[Motion, ...], warp: Warp, covariance: FloatArray) -> list[Start]:
    """Return where each of the motions takes a place that was known with `covariance` (2, 2) [px²]."""
    starts = []
    for motion in motions:
        linear = motion.now_from_before[:, :2]
        # What is wrong with the surroundings is wrong in the next picture too: sigmas add up, not variances.
        root = _root(linear @ covariance @ linear.T) + _LAYER_SHARE * _root(motion.disagreement)
        place = calmed(chained(motion.now_from_before, warp))
        starts.append(Start(place, root @ root + _STEP_SIGMA**2 * np.eye(2)))
    return starts


def _root(covariance: FloatArray) -> FloatArray:
    values, axes = np.linalg.eigh(covariance)
    return np.asarray((axes * np.sqrt(np.maximum(values, 0.0))) @ axes.T)


def conflict(fit: Fit, start: Start) -> bool:
    """Tell whether the patch was found farther from where it was carried than both allow."""
    if start.covariance is None:
        return False
    apart = fit.warp[:, 2] - start.warp[:, 2]
    return float(apart @ np.linalg.solve(fit.own + start.covariance, apart)) > _CONFLICT


def joined(fit: Fit, start: Start) -> Fit:
    """Return the fit with its centre moved towards where it was carried, where the patch itself is less sure.

    In each direction that both covariances share, the variance is the smaller of the two.
    """
    if start.covariance is None:
        return fit
    root = np.linalg.cholesky(fit.own + 1e-9 * np.eye(2))
    whitened = np.linalg.solve(root, np.linalg.solve(root, start.covariance).T)
    ratios, axes = np.linalg.eigh((whitened + whitened.T) / 2.0)
    ratios = np.maximum(ratios, 1e-9)
    frame = root @ axes
    apart = np.linalg.solve(frame, fit.warp[:, 2] - start.warp[:, 2])
    centre = start.warp[:, 2] + frame @ (ratios / (1.0 + ratios) * apart)
    own = frame @ np.diag(np.minimum(ratios, 1.0)) @ frame.T
    return replace(fit, warp=np.column_stack([fit.warp[:, :2], centre]), own=(own + own.T) / 2.0)
