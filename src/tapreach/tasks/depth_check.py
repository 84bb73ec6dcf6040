"""Whether what was followed is what was tapped: the tapped patch itself, looked for in all kept pictures.

Where the sweep finds one clear depth, the place is measured again from the tapped patch alone, which cannot
have slid, in every picture in which what was followed is not clearly it. docs/estimation.md, section 13.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.robot.config import RobotDescription
from tapreach.tasks.depth_search import KeptView, Swept, swept
from tapreach.tasks.sighting import Sighting
from tapreach.vision.core import looseness, seen_from_elsewhere
from tapreach.vision.depth_sweep import DepthSweep
from tapreach.vision.image_io import Gray
from tapreach.vision.look import Fit, Look, fit_look, tapped_look
from tapreach.vision.patch import patch_of_half
from tapreach.vision.warp import Warp, scale_of, warp_at

_LEAST_AGREEMENT = 0.6
"""Share of the thing's own samples that must agree where it is measured."""
_SLACK = 0.05
"""So much less may agree there than where all pictures together say that it lies."""
_NEAR, _SURE = 1.0, 0.8
"""A place followed to so near [samples] where it is expected, where so much agrees, is not measured again."""
_ENOUGH = 0.85
"""Where so much agrees no other start is tried."""
_GATE = 16.0
"""Squared distance from where it is expected that is more than chance: four sigma."""
_SAME = 2.0
"""Two measurements so many sigmas apart at most may be of the same place."""
_LEAST_SIGMA = 0.15
_LEAST_VIEWS = 3
_HALF, _FINE_HALF = 8, 12
"""The patch that is compared: so many samples to either side, of the tapped picture or of one seen from
nearer. A larger one sees more of what is behind.
"""
_UNCONFIRMED = 2.0
"""Sigmas of sightings that cannot be confirmed count so many times; measured on taps that could not be."""


@dataclass(frozen=True, eq=False)
class Checked:
    """What is to be believed of the kept sightings.

    sightings: the tapped one first. layer: (n²,) how surely each sample of the patch is of the thing; None
    where nothing is confirmed, and `doubt` then says why if something speaks against it. newest: where the
    tapped patch is in the newest picture, None where it is not found there and was not followed there either.
    """

    sightings: tuple[Sighting, ...]
    layer: FloatArray | None = None
    newest: Warp | None = None
    doubt: str = ""


@dataclass(frozen=True, eq=False)
class Anchor:
    """The picture whose patch the others are compared with: the tapped one, or later one seen from nearer.

    look: of its patch. loose: (2, 2) [px²], see core.looseness. from_tapped: (2, 2) from the tapped patch to
    its pixels. sigma: of its place against the tapped one [px].
    """

    look: Look
    loose: FloatArray
    from_tapped: FloatArray
    sigma: float

    @classmethod
    def at(cls, picture: Gray, warp: Warp, sigma: float) -> "Anchor":
        """Return the anchor at a place: warp (2, 3) from the tapped patch to the picture.

        Its patch shows as much of the thing as the tapped one, the finer the nearer it is seen from.
        """
        (u, v), scale = map(float, warp[:, 2]), scale_of(warp)
        half = _HALF if scale <= 1.0 else _FINE_HALF
        patch = patch_of_half(picture, warp_at(u, v, max(1.0, scale * _HALF / half)), half)
        return cls(tapped_look(patch, picture), looseness(picture, u, v), warp[:, :2], sigma)


class DepthCheck:
    """Checks one tapped place against the patch of an anchor."""

    def __init__(self, anchor: Anchor, description: RobotDescription) -> None:
        self._anchor, self._description = anchor, description
        self._look, self._loose = anchor.look, anchor.loose
        self._sweep = DepthSweep(anchor.look.patch)

    def check(self, views: Sequence[KeptView]) -> Checked:
        """Compare and measure again. views: in the order of time, the anchor's first."""
        found = swept(self._sweep, views, self._description)
        if found is None:
            return Checked(tuple(view.sighting for view in views if view.is_seen))
        if not found.curve.is_clear:
            return Checked(_doubted(views), doubt="it looks alike at several distances")
        measured = [self._measured(found, number, view) for number, view in enumerate(views[1:], start=1)]
        sightings = (views[0].sighting, *(each for each in measured if each is not None))
        if len(sightings) < _LEAST_VIEWS:
            return Checked(_doubted(views), doubt="it is found again in too few pictures")
        newest = measured[-1]
        if newest is None:
            return Checked(sightings, found.layer)
        place = newest.pixel.to_array()
        linear = _with_linear(place, found.warps[-1], 1.0 / self._sweep.patch.step)[:, :2]
        warp = np.column_stack([linear @ self._anchor.from_tapped, place])
        return Checked(sightings, found.layer, warp)

    def _measured(self, found: Swept, number: int, view: KeptView) -> Sighting | None:
        """Return the sighting of a view, None where the patch is not seen."""
        expected, covariance = found.warps[number], found.covariances[number]
        if not np.all(np.isfinite(expected)):  # it would lie behind the camera
            return None
        if view.is_seen and self._is_surely(view, expected, found.layer):
            return view.sighting
        fit = self._fit(found, number, view)
        if fit is None:
            return _unconfirmed(view) if _is_followed_to(view, expected, covariance) else None
        fit = fit.fused_with(expected[:, 2], covariance)
        sigma = max(_LEAST_SIGMA, seen_from_elsewhere(fit.covariance, fit.warp, self._loose))
        sigma = math.hypot(sigma, scale_of(fit.warp) * self._anchor.sigma)
        pixel = Pixel(*map(float, fit.warp[:, 2]))
        if not pixel.is_inside(self._description.camera.model().size):
            return None
        scale = scale_of(fit.warp[:, :2] @ self._anchor.from_tapped)
        again = replace(view.sighting, pixel=pixel, sigma=sigma, scale=scale)
        if view.is_seen and _says_the_same_better(view.sighting, again, expected, covariance):
            return view.sighting
        return replace(again, sigma=math.hypot(sigma, view.moved_px))

    def _is_surely(self, view: KeptView, expected: Warp, layer: FloatArray) -> bool:
        """Tell whether the place that was followed is the one without measuring again."""
        place = view.sighting.pixel.to_array()
        if float(np.linalg.norm(place - expected[:, 2])) > _NEAR * scale_of(expected):
            return False
        warp = _with_linear(place, expected)
        return self._sweep.agreement(view.pyramid, warp, layer) >= _SURE

    def _fit(self, found: Swept, number: int, view: KeptView) -> Fit | None:
        """Return where the patch lies, from where it is expected or else from where it was followed to."""
        expected, covariance = found.warps[number], found.covariances[number]
        look = self._look.with_layer(found.layer)
        step = self._sweep.patch.step
        starts = [_with_linear(expected[:, 2], expected, 1.0 / step)]
        if view.is_seen:
            starts.append(_with_linear(view.sighting.pixel.to_array(), expected, 1.0 / step))
        least = max(_LEAST_AGREEMENT, self._sweep.agreement(view.pyramid, expected, found.layer) - _SLACK)
        best: tuple[float, Fit] | None = None
        for start in starts:
            fit = fit_look(look, view.pyramid[0], start)
            if fit is None or not _is_expected(fit.warp[:, 2], expected, covariance):
                continue
            of_samples = _with_linear(fit.warp[:, 2], fit.warp, step)
            agreement = self._sweep.agreement(view.pyramid, of_samples, found.layer)
            if agreement >= (best[0] if best is not None else least):
                best = agreement, fit
            if agreement >= _ENOUGH:
                break
        return best[1] if best is not None else None


def _with_linear(place: FloatArray, warp: Warp, factor: float = 1.0) -> Warp:
    """Return the warp moved to a place (2,), its linear part times `factor`."""
    return np.column_stack([factor * warp[:, :2], place])


def _doubted(views: Sequence[KeptView]) -> tuple[Sighting, ...]:
    first, *others = (view for view in views if view.is_seen)
    return (first.sighting, *map(_unconfirmed, others))


def _unconfirmed(view: KeptView) -> Sighting:
    return replace(view.sighting, sigma=_UNCONFIRMED * view.sighting.sigma)


def _is_followed_to(view: KeptView, expected: Warp, covariance: FloatArray) -> bool:
    """Tell whether the place was followed to where it is expected, as well as that is known."""
    if not view.is_seen:
        return False
    spread = covariance + view.sighting.sigma**2 * np.eye(2)
    return _is_expected(view.sighting.pixel.to_array(), expected, spread)


def _says_the_same_better(
    followed: Sighting, again: Sighting, expected: Warp, covariance: FloatArray
) -> bool:
    """Tell whether what was followed is surer than what was measured again, and may be of the same place."""
    place = followed.pixel.to_array()
    apart = float(np.linalg.norm(again.pixel.to_array() - place))
    is_same = apart < _SAME * math.hypot(again.sigma, followed.sigma)
    spread = covariance + followed.sigma**2 * np.eye(2)
    return followed.sigma < again.sigma and is_same and _is_expected(place, expected, spread)


def _is_expected(place: FloatArray, expected: Warp, covariance: FloatArray) -> bool:
    apart = place - expected[:, 2]
    return float(apart @ np.linalg.solve(covariance, apart)) < _GATE
