"""How two pictures of the floor are out of line: what is left of the errors of poses and mount.

Most of what is seen below the horizon is floor, so that it can tell; what stands on it is outvoted. Source:
Lucas and Kanade 1981, with the weights of Geman and McClure.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.vision.plane_sweep import Evened

_PASSES = 6
_OUTLIER = 0.8
"""Difference of evened pictures at which a pixel counts a quarter."""
_STIFFNESS = 0.0002
"""What holds the pictures where they are, as a share of the texture that an even picture would have."""
_BLUR = 1.5
"""Deviation by which both are blurred, so that narrow lines overlap [px]."""
_MOST = 8.0
"""Farther off [px] than this they are not what they are said to be."""
_LEAST_PIXELS = 200


def aligned_on_floor(
    reference: Evened, other: Evened, to_other: FloatArray, may_be_floor: NDArray[np.bool_]
) -> FloatArray:
    """Return the affinity (3, 3) of the other picture's pixels to put after the floor's homography (3, 3),
    so that the floor agrees; the identity where the floor has no texture or is not seen in both.

    may_be_floor (rows, columns): pixels of the reference that are compared.
    """
    rows, columns = other.shape
    reference, other = _blurred(reference), _blurred(other)
    centred = np.array([[2.0 / columns, 0.0, -1.0], [0.0, 2.0 / rows, -1.0], [0.0, 0.0, 1.0]])
    slopes = [np.asarray(cv2.Scharr(other, cv2.CV_32F, *axis) / 32.0) for axis in ((1, 0), (0, 1))]
    found = np.zeros((2, 3))
    for _ in range(_PASSES):
        moved = _affinity(found, centred) @ to_other
        there, by_u, by_v = (_warped(each, moved, reference.shape) for each in (other, *slopes))
        used = may_be_floor & (there < 100.0) & (by_u < 100.0) & (by_v < 100.0)
        v, u = np.nonzero(used)
        if len(u) < _LEAST_PIXELS:
            return np.eye(3)
        at = moved @ np.stack([u, v, np.ones(len(u))])
        places = (centred @ (at / at[2])).T
        by_found = np.concatenate([by_u[used, None] * places, by_v[used, None] * places], axis=1)
        error = (reference[used] - there[used]).astype(np.float64)
        weighted = by_found * (1.0 / (1.0 + (error / _OUTLIER) ** 2) ** 2)[:, None]
        stiff = _STIFFNESS * len(error)
        normal = weighted.T @ by_found + stiff * np.eye(6)
        found = found + np.linalg.solve(normal, weighted.T @ error - stiff * found.ravel()).reshape(2, 3)
    return _affinity(found, centred) if np.abs(found).sum(axis=1).max() <= _MOST else np.eye(3)


def _blurred(picture: Evened) -> Evened:
    return np.asarray(cv2.GaussianBlur(picture, (0, 0), _BLUR), np.float32)


def _affinity(found: FloatArray, centred: FloatArray) -> FloatArray:
    moved = np.eye(3)
    moved[:2] += found @ centred
    return moved


def _warped(picture: Evened, to_picture: FloatArray, shape: tuple[int, ...]) -> Evened:
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (shape[1], shape[0])
    return np.asarray(
        cv2.warpPerspective(
            picture, to_picture, size, flags=flags, borderMode=cv2.BORDER_CONSTANT, borderValue=1e3
        ),
        np.float32,
    )
