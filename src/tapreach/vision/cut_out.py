"""The parts of two pictures in which a few corners are followed: pyramids of whole pictures cost more than
the following itself.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.vision.image_io import Gray

_LEAST = 16


@dataclass(frozen=True, eq=False)
class CutOut:
    """Parts of equal size; the first pixel of each lies at `before_at`, `now_at` (2,) (u, v) of its whole."""

    before: Gray
    now: Gray
    before_at: NDArray[np.float32]
    now_at: NDArray[np.float32]


def cut_around(
    before: Gray, now: Gray, points: NDArray[np.float32], shift: tuple[float, float], room: int
) -> CutOut | None:
    """Return what surrounds `points` (n, 2) of the earlier picture, n > 0, with `room` [px] on all sides, and
    the same part moved by `shift` [px] of the later one. None where hardly any of it lies on both.
    """
    across, down = round(shift[0]), round(shift[1])
    height, width = before.shape
    low, high = points.min(axis=0), points.max(axis=0)
    left = max(0, -across, math.floor(low[0]) - room)
    top = max(0, -down, math.floor(low[1]) - room)
    right = min(width, width - across, math.ceil(high[0]) + room)
    bottom = min(height, height - down, math.ceil(high[1]) + room)
    if right - left < _LEAST or bottom - top < _LEAST:
        return None
    return CutOut(
        before[top:bottom, left:right],
        now[top + down : bottom + down, left + across : right + across],
        np.array([left, top], np.float32),
        np.array([left + across, top + down], np.float32),
    )
