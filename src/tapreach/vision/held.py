"""How wide the claw's end is in the picture: fingers that met, or fingers kept apart by what is between them.

Two pictures, with the arm elsewhere in the second: what differs belongs to arm, claw and what it holds, or to
the background that these hid. Across the end of the claw the changed places reach from the outer side of one
finger to that of the other, whatever the colours; a closed empty claw is as wide as its two fingers, a
holding one as wide as the thing and both fingers. The likelihood of each width is computed from the share of
changed pixels across.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array
from tapreach.vision.claw_motion import Change

CHANGED, UNCHANGED = 0.85, 0.06
"""Chances that a pixel differs: on the claw or what it holds, and beside it (shadows, noise of the JPEG)."""
_LEAST_LEVEL, _MOST_LEVEL = 12.0, 40.0
_NOISES, _QUIET = 4.0, 0.2
"""Grey levels that count as a change: so many times what the quietest fifth of the picture differs by."""
_WEIGHT = 0.6
"""Places a millimetre or two apart tell much the same: each counts as so much of an independent one."""


@dataclass(frozen=True, eq=False)
class AcrossClaw:
    """Places across the end of the claw. aside (n,): how far each is from the middle [m], n > 0; pixels
    (n, k, 2): of each some places that are there above each other [px], NaN where the arm hides them.
    """

    aside: FloatArray
    pixels: FloatArray

    def __post_init__(self) -> None:
        finite_array("aside", self.aside, (None,))
        if self.pixels.ndim != 3 or self.pixels.shape[0] != len(self.aside) or self.pixels.shape[2] != 2:
            raise InputError(f"pixels have shape {self.pixels.shape}; it must be ({len(self.aside)}, k, 2)")


def shares_changed(change: Change, across: AcrossClaw) -> FloatArray:
    """Return how much of each place has changed, (n,) 0 to 1; NaN where nothing of it is seen."""
    quiet = float(np.quantile(change, _QUIET))
    level = min(max(_LEAST_LEVEL, _NOISES * quiet), _MOST_LEVEL)
    height, width = change.shape
    rounded = np.round(np.nan_to_num(across.pixels, nan=-1.0)).astype(int)
    u, v = rounded[..., 0], rounded[..., 1]
    is_seen = (u >= 0) & (v >= 0) & (u < width) & (v < height)
    is_changed = change[np.clip(v, 0, height - 1), np.clip(u, 0, width - 1)] > level
    count = is_seen.sum(axis=1)
    shares = (is_changed & is_seen).sum(axis=1) / np.maximum(count, 1)
    return np.asarray(np.where(count > 0, shares, np.nan))


def log_likelihoods(aside: FloatArray, shares: FloatArray, half_widths: FloatArray) -> FloatArray:
    """Return for each half width (m,) [m] of the claw's end how well it explains the shares (n,), (m,)."""
    known = np.isfinite(shares)
    here, changed = np.abs(aside[known]), shares[known]
    is_claw = here[None, :] <= half_widths[:, None]
    chance = np.where(is_claw, CHANGED, UNCHANGED)
    each = changed * np.log(chance) + (1.0 - changed) * np.log(1.0 - chance)
    return np.asarray(_WEIGHT * each.sum(axis=1))


@dataclass(frozen=True)
class ClawWidth:
    """Half the width of the claw's end that explains the pictures best [m], and the logarithm of how much
    better something held explains them than fingers that met. disagreement: how much of what was seen even
    the best does not explain, 0 to 1; large when something else moved as well.
    """

    half_width: float
    log_odds: float
    disagreement: float


def claw_width(
    looks: Sequence[tuple[Change, AcrossClaw]], closed_half: float, least_half: float, widest_half: float
) -> ClawWidth:
    """Return what several looks say together. closed_half: of an empty closed claw; least_half, widest_half:
    between these when it holds something [m]. All widths in between are as likely beforehand.
    """
    empty = closed_half + np.linspace(-0.25, 0.5, 7) * closed_half
    holding = np.linspace(least_half, widest_half, 25)
    seen = [(across.aside, shares_changed(change, across)) for change, across in looks]
    by_empty = np.sum([log_likelihoods(*each, empty) for each in seen], axis=0)
    by_holding = np.sum([log_likelihoods(*each, holding) for each in seen], axis=0)
    every, weights = np.concatenate([empty, holding]), np.concatenate([by_empty, by_holding])
    best = float(every[int(np.argmax(weights))])
    return ClawWidth(best, _mean_of(by_holding) - _mean_of(by_empty), _disagreement(seen, best))


def _disagreement(seen: Sequence[tuple[FloatArray, FloatArray]], half_width: float) -> float:
    aside, shares = (np.concatenate(each) for each in zip(*seen, strict=True))
    known = np.isfinite(shares)
    if not known.any():
        return 1.0
    return float(np.mean(np.abs(shares[known] - (np.abs(aside[known]) <= half_width))))


def _mean_of(logs: FloatArray) -> float:
    """Return the logarithm of the mean of what `logs` are logarithms of."""
    top = float(logs.max())
    return top + float(np.log(np.mean(np.exp(logs - top))))
