"""How alike pictures are where the lines of sight of one of them meet supposed planes.

Small windows are compared after their brightness and contrast are evened out: near 0 where they agree or
where there is nothing to see, about 1 where they have nothing in common. What is hidden in some of the
pictures is compared with the better half of them. Source: Collins, "A space-sweep approach to true
multi-image matching", CVPR 1996; Kang, Szeliski, Chai, "Handling occlusions in dense multi-view stereo",
CVPR 2001.
"""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.vision.image_io import BrokenPicture, Gray, decode_gray

Evened = NDArray[np.float32]
"""(rows, columns): a picture whose windows all have mean 0 and, where there is texture, deviation 1."""
Costs = NDArray[np.float32]
"""(planes, rows, columns)."""

UNSEEN = np.float32(9.0)
"""The cost where no other picture reaches."""
_WINDOW = (7, 7)
_EVENED_OVER = (11, 11)
_WEAK = 5.0
"""Deviation at which a window is half evened out: less is noise [grey levels, roots of brightness]."""
_MOST = 4.0
"""Squared differences above tell no more."""
_ROOTS = np.round(255.0 * np.sqrt(np.arange(256) / 255.0)).astype(np.uint8)


def evened_picture(jpeg: bytes, lens: Camera, pinhole: Camera) -> Evened | None:
    """Return a JPEG's picture as `pinhole` would show it, evened out; None where it is broken or of another
    size than the lens.
    """
    picture = decode_gray(jpeg)
    if isinstance(picture, BrokenPicture) or picture.shape != (lens.size.height, lens.size.width):
        return None
    straight = picture
    if any(lens.distortion):
        straight = np.asarray(cv2.undistort(picture, lens.matrix(), np.array(lens.distortion)), np.uint8)
    size = (pinhole.size.width, pinhole.size.height)
    small = cv2.resize(cv2.LUT(straight, _ROOTS), size, interpolation=cv2.INTER_AREA)
    return evened(np.asarray(small, np.uint8))


def evened(picture: Gray) -> Evened:
    """Return a grey picture evened out."""
    values = picture.astype(np.float32)
    mean = cv2.blur(values, _EVENED_OVER)
    variance = cv2.blur(values * values, _EVENED_OVER) - mean * mean
    return np.asarray((values - mean) / np.sqrt(np.maximum(variance, 0.0) + _WEAK**2), np.float32)


def swept(reference: Evened, others: Sequence[Evened], to_others: FloatArray) -> Costs:
    """Return the cost of each plane at each pixel of the reference.

    to_others (planes, others, 3, 3): homographies by the planes, pixels of the reference to pixels of each.
    """
    costs = np.empty((len(to_others), *reference.shape), np.float32)
    for plane, homographies in enumerate(to_others):
        compared = [_cost(reference, *pair) for pair in zip(others, homographies, strict=True)]
        costs[plane] = _of_better_half(np.array(compared))
    return costs


def _cost(reference: Evened, other: Evened, to_other: FloatArray) -> Evened:
    rows, columns = reference.shape
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    there = cv2.warpPerspective(
        other, to_other, (columns, rows), flags=flags, borderMode=cv2.BORDER_CONSTANT, borderValue=1e3
    )
    difference = cv2.subtract(reference, np.asarray(there, np.float32))
    squared = np.minimum(difference * difference, np.float32(_MOST))
    cost = np.asarray(cv2.blur(squared, _WINDOW), np.float32) * np.float32(0.5)
    cost[there > 100.0] = UNSEEN
    return cost


def _of_better_half(costs: Costs) -> Evened:
    """Return the mean of the lower half of what several pictures say, the middle one included."""
    half = (len(costs) + 1) // 2
    if half == len(costs):
        return np.asarray(costs.mean(axis=0), np.float32)
    return np.asarray(np.partition(costs, half - 1, axis=0)[:half].mean(axis=0), np.float32)
