"""The depth of a tapped patch by all kept pictures at once, anchored at the tapped one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.depth_geometry import DepthGeometry
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.straightening import straightened
from tapreach.vision.depth_curve import DepthCurve
from tapreach.vision.depth_sweep import Compared, DepthSweep
from tapreach.vision.image_io import Gray

NEAREST, FARTHEST = 0.2, 12.0
"""Depths [m] that are swept."""
_STEP_PX = 1.5
"""So much the place moves from one depth to the next, in the view in which it moves most."""
_FEWEST_DEPTHS, _MOST_DEPTHS = 12, 120
_MOST_VIEWS = 8
_MOST_POSE_SIGMA = 2.5
"""A view in which the poses tell the place worse than this [samples] is not swept."""
_MOST_REACH = 3
_LEFT_OPEN = 0.3
"""What the shift to a whole sample leaves open [samples]."""
_LEAST_PARALLAX = 4.0
"""So far the place must move in some view over all depths for any to be told [px]."""
_USUAL_DEPTH = 1.0
_OFF_THE_PICTURE = np.array([[1.0, 0.0, -1e3], [0.0, 1.0, -1e3]])


@dataclass(frozen=True, eq=False)
class KeptView:
    """A frame's pictures and its sighting; where the place was not seen in it, `is_seen` is False and the
    sighting tells the pose alone. moved_px: see target_watch.Shot.
    """

    sighting: Sighting
    pyramid: Sequence[Gray]
    moved_px: float = 0.0
    is_seen: bool = True


@dataclass(frozen=True, eq=False)
class Swept:
    """What the kept pictures say of the depth.

    layer: (n²,) how surely each sample of the patch lies at that depth. warps: (views, 2, 3) where the patch
    lies then in every view. covariances: (views, 2, 2) [px²] of its centre there; what the pictures say of
    the depth is shared out among the views.
    """

    curve: DepthCurve
    layer: FloatArray
    warps: FloatArray
    covariances: FloatArray


def swept(sweep: DepthSweep, views: Sequence[KeptView], description: RobotDescription) -> Swept | None:
    """Return what the views say; the first is the tapped one. None where they are from too nearly one place,
    or where their poses are too little known.
    """
    sightings = [view.sighting for view in views]
    straight = straightened(sightings, description, by_every_way=True)
    patch = sweep.patch
    geometry = DepthGeometry(straight, description, sightings[0].pixel, patch.half, patch.step)
    told = _told_views(geometry, len(views), patch.step)
    inverse_depths = _grid(geometry, list(told))
    if inverse_depths is None:
        return None
    compared = {
        number: _compared(sweep, views[number].pyramid, geometry.warps(number, inverse_depths), covariance)
        for number, covariance in told.items()
    }
    curve = DepthCurve.of(inverse_depths, [each.cost for each in compared.values()], sweep.most_cost)
    layer = np.mean([each.agreement[curve.best] for each in compared.values()], axis=0, dtype=np.float64)
    return Swept(curve, np.asarray(layer), *_places(geometry, curve, compared, len(views), patch.step))


def _told_views(geometry: DepthGeometry, count: int, step: float) -> dict[int, FloatArray]:
    """Return the views whose poses tell the place well enough, with the covariance (2, 2) [px²] of it."""
    told = {}
    for view in range(1, count):
        covariance = geometry.covariance(view, 1.0 / _USUAL_DEPTH)
        if float(np.linalg.eigvalsh(covariance)[1]) < (_MOST_POSE_SIGMA * step) ** 2:
            told[view] = covariance + (_LEFT_OPEN * step) ** 2 * np.eye(2)
    spread = np.linspace(0, len(told) - 1, min(len(told), _MOST_VIEWS))
    chosen = [list(told)[round(float(number))] for number in spread]
    return {view: told[view] for view in chosen}


def _grid(geometry: DepthGeometry, views: Sequence[int]) -> FloatArray | None:
    """Return inverse depths (m,) [1/m] so close that the place moves by no more than a step in any view."""
    ends = 1.0 / FARTHEST, 1.0 / NEAREST
    coarse = np.linspace(*ends, 24)
    longest = 0.0
    for view in views:
        moved = np.linalg.norm(np.diff(geometry.warps(view, coarse)[:, :, 2], axis=0), axis=1)
        longest = max(longest, float(np.nansum(np.minimum(moved, _STEP_PX * _MOST_DEPTHS / 3.0))))
    if longest < _LEAST_PARALLAX:
        return None
    return np.linspace(*ends, int(np.clip(longest / _STEP_PX, _FEWEST_DEPTHS, _MOST_DEPTHS)))


def _compared(
    sweep: DepthSweep, pyramid: Sequence[Gray], warps: FloatArray, covariance: FloatArray
) -> Compared:
    is_valid = np.all(np.isfinite(warps), axis=(1, 2))
    usable = np.where(is_valid[:, None, None], warps, _OFF_THE_PICTURE)
    sigma = float(np.sqrt(np.linalg.eigvalsh(covariance)[1])) / sweep.patch.step
    return sweep.compare(pyramid, usable, covariance, min(round(2.0 * sigma), _MOST_REACH))


def _places(
    geometry: DepthGeometry, curve: DepthCurve, compared: dict[int, Compared], count: int, step: float
) -> tuple[FloatArray, FloatArray]:
    """Return warps (count, 2, 3) and covariances (count, 2, 2) [px²], see Swept."""
    rho = curve.inverse_depth
    # Every view has its share in what is known of the depth: together they must not know more than that.
    apart = np.array([rho, rho + curve.sigma * len(compared) ** 0.5])
    warps, covariances = [], []
    for view in range(count):
        warp, beside = geometry.warps(view, apart)
        along = np.nan_to_num(beside[:, 2] - warp[:, 2])
        spread = (
            geometry.covariance(view, rho) + np.outer(along, along) + (_LEFT_OPEN * step) ** 2 * np.eye(2)
        )
        if view in compared:
            warp[:, 2] += compared[view].shifts[curve.best]
        warps.append(warp)
        covariances.append(spread)
    return np.stack(warps), np.stack(covariances)
