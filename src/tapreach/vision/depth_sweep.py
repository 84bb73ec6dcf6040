"""How well a tapped patch agrees with other pictures at every supposed depth: a plane sweep of one patch.

Sample by sample and robustly: at an outline part of the patch shows what lies behind, which no depth of the
thing makes agree, and must not spoil the rest. Source: Collins, "A space-sweep approach to true multi-image
matching", CVPR 1996; Geman and McClure's loss. docs/estimation.md, section 13.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import Patch
from tapreach.vision.region import Values
from tapreach.vision.warp import Warp, patch_grid

_NOISE = 3.0
"""Grey levels that a sample differs by though all is right."""
_BLURRED = 0.35
"""Samples by which it may be off the right place: times its slope that is a difference as well."""
_MOST_COST = 4.0
"""What a sample that does not belong to the thing costs at most [squared sigmas]."""
_NEIGHBOURS = 3.0
"""Errors of neighbouring samples are alike: about so many count as one."""
_LEAST_GAIN, _MOST_GAIN = 0.7, 1.4
_PASSES = 2


@dataclass(frozen=True, eq=False)
class Compared:
    """One picture against the patch, seen through each of m warps.

    cost: (m,) of the samples and of the shift [squared sigmas]; NaN where the place is not on the picture.
    shifts: (m, 2) [px] to where it agrees best.
    agreement: (m, n²) of each sample, 0 to 1.
    """

    cost: FloatArray
    shifts: FloatArray
    agreement: Values


class DepthSweep:
    """Compares pictures with `patch`, at its own sampling."""

    def __init__(self, patch: Patch) -> None:
        self.patch = patch
        self._values = patch.values.astype(np.float32).ravel()
        slopes = (patch.gradients**2).sum(axis=1)
        self._variance = (_NOISE**2 + _BLURRED**2 * slopes).astype(np.float32)
        self._weights = (patch.weights / _NEIGHBOURS).astype(np.float32)

    @property
    def most_cost(self) -> float:
        """What one picture costs in which nothing agrees."""
        return _MOST_COST * float(self._weights.sum())

    def compare(
        self, pyramid: Sequence[Gray], warps: FloatArray, covariance: FloatArray, reach: int
    ) -> Compared:
        """Return how a picture agrees through `warps` (m, 2, 3), from samples of the patch to pixels.

        pyramid: the picture, and smaller ones (`pyramid_of`). covariance: (2, 2) [px²] of where the place
        falls on it, for what is not known of the cameras. reach: shifts up to so many samples are tried.
        """
        sampled = _sampled(pyramid, warps, self.patch.half + reach)
        side, count = 2 * self.patch.half + 1, len(warps)
        shifts = _shifts(reach)
        moved = np.einsum("mij,sj->msi", warps[:, :, :2], shifts)
        of_shift = np.einsum("msi,ij,msj->ms", moved, np.linalg.inv(covariance), moved)
        windows = [_windows(sampled, side, np.tile(shift, (count, 1))) for shift in shifts]
        of_samples = np.stack([self._cost(each) for each in windows], axis=1)
        best, rows = np.argmin(of_samples + of_shift, axis=1), np.arange(count)
        cost, agreement = self._robust(_windows(sampled, side, shifts[best]))
        is_seen = _is_on(warps[:, :, 2], pyramid[0].shape)
        return Compared(np.where(is_seen, cost + of_shift[rows, best], np.nan), moved[rows, best], agreement)

    def agreement(self, pyramid: Sequence[Gray], warp: Warp, layer: FloatArray) -> float:
        """Return the share of the samples of a `layer` (n²,), 0 to 1 each, that agree through one warp."""
        windows = _sampled(pyramid, warp[None], self.patch.half).reshape(1, -1)
        weights = self._weights * layer
        return float(self._robust(windows)[1][0] @ weights / weights.sum())

    def _cost(self, seen: Values) -> FloatArray:
        """Return the cost (m,) of windows (m, n²) of the patch's own brightness, but for an offset."""
        weights = self._weights / self._variance
        difference = seen - self._values
        difference = difference - ((difference @ weights) / weights.sum())[:, None]
        return np.asarray(_loss(difference**2 / self._variance) @ self._weights, dtype=np.float64)

    def _robust(self, seen: Values) -> tuple[FloatArray, Values]:
        """Return cost (m,) and agreement (m, n²) of windows (m, n²), each with its own gain and offset."""
        agreement = np.ones_like(seen)
        for _ in range(_PASSES + 1):
            squared = self._errors(seen, agreement) ** 2 / self._variance
            agreement = np.square(1.0 / (1.0 + squared / _MOST_COST))
        return np.asarray(_loss(squared) @ self._weights, dtype=np.float64), agreement

    def _errors(self, seen: Values, agreement: Values) -> Values:
        weights = agreement * (self._weights / self._variance)
        total = weights.sum(axis=1)
        mean_seen = (weights * seen).sum(axis=1) / total
        mean_patch = (weights @ self._values) / total
        seen = seen - mean_seen[:, None]
        values = self._values - mean_patch[:, None]
        together = (weights * seen * values).sum(axis=1)
        spread = np.maximum((weights * values * values).sum(axis=1), 1e-9)
        gain = np.clip(together / spread, _LEAST_GAIN, _MOST_GAIN)
        return np.asarray(seen - gain[:, None] * values, dtype=np.float32)


def _loss(squared: Values) -> Values:
    return np.asarray(_MOST_COST * squared / (_MOST_COST + squared), dtype=np.float32)


def pyramid_of(picture: Gray, levels: int = 3) -> tuple[Gray, ...]:
    """Return the picture and `levels` - 1 smaller ones, each half the size of the one before."""
    pyramid = [picture]
    for _ in range(levels - 1):
        pyramid.append(np.asarray(cv2.pyrDown(pyramid[-1]), dtype=np.uint8))
    return tuple(pyramid)


def _sampled(pyramid: Sequence[Gray], warps: FloatArray, half: int) -> Values:
    """Return the grey values (m, side, side) seen through warps (m, 2, 3), each from the picture of the
    pyramid that is nearest to its scale.
    """
    side = 2 * half + 1
    grid = patch_grid(half).T
    pixels = warps[:, :, :2] @ grid + warps[:, :, 2:]
    levels = _levels(warps, len(pyramid))
    sampled = np.empty((len(warps), side, side), dtype=np.float32)
    for level in np.unique(levels):
        at = levels == level
        x, y = (pixels[at] / 2.0**level).astype(np.float32).swapaxes(0, 1).reshape(2, -1, side)
        values = cv2.remap(pyramid[level], x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        sampled[at] = values.reshape(-1, side, side)
    return sampled


def _levels(warps: FloatArray, count: int) -> npt.NDArray[np.int_]:
    scales = np.sqrt(np.abs(np.linalg.det(warps[:, :, :2])))
    levels = np.round(np.log2(np.maximum(scales, 1.0)) - 0.2)
    return np.asarray(np.clip(levels, 0, count - 1), dtype=np.int_)


def _shifts(reach: int) -> npt.NDArray[np.int_]:
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    return np.stack([x.ravel(), y.ravel()], axis=1)


def _windows(sampled: Values, side: int, shifts: npt.NDArray[np.int_]) -> Values:
    """Return from each sampled square (m, ., .) the window at its own shift (m, 2), as rows (m, side²)."""
    reach = (sampled.shape[1] - side) // 2
    x, y = (shifts + reach).T
    windows = sliding_window_view(sampled, (side, side), axis=(1, 2))
    return np.asarray(windows[np.arange(len(sampled)), y, x].reshape(len(sampled), -1), dtype=np.float32)


def _is_on(places: FloatArray, shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    height, width = shape[:2]
    return np.asarray(np.all((places >= 0.0) & (places <= (width - 1, height - 1)), axis=1))
