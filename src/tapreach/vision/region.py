"""The part of a picture around a patch, and sampling it through a warp."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.vision.image_io import Gray
from tapreach.vision.warp import Warp, scale_of

Values = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Region:
    """Grey values (height, width) cut out of a picture; its first sample is the pixel (u, v)."""

    values: Values
    u: int
    v: int

    def sample(self, warp: Warp, half: int) -> Values:
        """Return the (2·half + 1)² grey values seen through `warp`, interpolated linearly.

        Beyond the region the value at its edge is repeated; `warp.is_seen` tells where a picture ends.
        """
        corner = warp[:, 2] - warp[:, :2] @ (half, half) - (self.u, self.v)
        side = 2 * half + 1
        seen = cv2.warpAffine(
            self.values,
            np.column_stack([warp[:, :2], corner]),
            (side, side),
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        )
        return np.asarray(seen, dtype=np.float32)


def region_around(picture: Gray, warp: Warp, half: int) -> Region:
    """Return the part of `picture` that a patch of `half` sees through `warp`, with some to spare.

    Where the warp would skip pixels the region is smoothed first, so that fine texture does not alias.
    """
    scale = scale_of(warp)
    reach = math.ceil(half * float(np.abs(warp[:, :2]).sum(axis=1).max())) + 8
    height, width = picture.shape
    u = min(max(round(float(warp[0, 2])), 0), width - 1)
    v = min(max(round(float(warp[1, 2])), 0), height - 1)
    left, top = max(0, u - reach), max(0, v - reach)
    values = picture[top : v + reach + 1, left : u + reach + 1].astype(np.float32)
    if scale > 1.2:
        blurred = cv2.GaussianBlur(values, (0, 0), 0.5 * math.sqrt(scale * scale - 1.0))
        values = np.asarray(blurred, dtype=np.float32)
    return Region(values, left, top)
