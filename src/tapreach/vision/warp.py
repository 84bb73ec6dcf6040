"""Affine warps from a patch to a picture, as (2, 3) arrays.

A warp maps patch coordinates (x right, y down, (0, 0) at the patch's centre) to pixels (u, v): its last
column is the pixel of the patch's centre.
"""

import math

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray

Warp = FloatArray
"""(2, 3): linear part, and the pixel of the patch's centre."""


def warp_at(u: float, v: float, scale: float = 1.0) -> Warp:
    """Return the warp that shows the patch upright at (u, v), `scale` picture pixels to a patch pixel."""
    return np.array([[scale, 0.0, u], [0.0, scale, v]])


def chained(outer: Warp, inner: Warp) -> Warp:
    """Return the warp that applies `inner` first and then `outer`."""
    linear = outer[:, :2] @ inner[:, :2]
    return np.column_stack([linear, outer[:, :2] @ inner[:, 2] + outer[:, 2]])


def inverted(warp: Warp) -> Warp:
    """Return the warp that undoes `warp`; its linear part must be invertible."""
    linear = np.linalg.inv(warp[:, :2])
    return np.column_stack([linear, -linear @ warp[:, 2]])


def scale_of(warp: Warp) -> float:
    """Return the mean magnification: root of the area ratio."""
    return math.sqrt(abs(float(np.linalg.det(warp[:, :2]))))


def patch_grid(half: int) -> FloatArray:
    """Return the patch coordinates ((2·half + 1)², 2) of all samples, row by row."""
    y, x = np.mgrid[-half : half + 1, -half : half + 1]
    return np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64)


def is_seen(warp: Warp, half: int, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Tell for each sample of the grid (n,) whether it falls on a picture of `shape` (height, width)."""
    pixels = patch_grid(half) @ warp[:, :2].T + warp[:, 2]
    height, width = shape[:2]
    return np.asarray(np.all((pixels >= 0.0) & (pixels <= (width - 1, height - 1)), axis=1))


def calmed(warp: Warp, kept: float = 0.88) -> Warp:
    """Return the warp with its turn and shear reduced to the share `kept`; scale and centre stay.

    A camera that stays upright sees little of either: what the picture does not keep up must not add up.
    """
    scale = scale_of(warp)
    upright = scale * np.eye(2)
    linear = upright + kept * (warp[:, :2] - upright)
    return np.column_stack([linear * (scale / scale_of(linear)), warp[:, 2]])
