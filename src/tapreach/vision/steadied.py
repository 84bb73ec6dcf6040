"""A picture laid over another one, background on background: a robot that moves its arm nods a little."""

import cv2
import numpy as np

from tapreach.vision.image_io import Color

_CORNERS, _QUALITY, _APART = 200, 0.01, 12
_LEAST_CORNERS = 12
_OUTLYING_PX = 1.0
_MOST_SHIFT_PX = 25.0


def steadied(picture: Color, onto: Color) -> Color:
    """Return `picture` moved, turned and scaled so that what stands still lies where it does in `onto`.

    The motion of most corners is taken, whatever moved besides. As it is where there are too few corners, or
    where they say that it moved by more than a nod.
    """
    now, before = (cv2.cvtColor(each, cv2.COLOR_BGR2GRAY) for each in (picture, onto))
    corners = cv2.goodFeaturesToTrack(before, _CORNERS, _QUALITY, _APART)
    if corners is None or len(corners) < _LEAST_CORNERS:
        return picture
    followed, found, _ = cv2.calcOpticalFlowPyrLK(before, now, corners, None)  # type: ignore[call-overload]
    is_found = found.ravel() == 1
    if is_found.sum() < _LEAST_CORNERS:
        return picture
    now_from_before, _ = cv2.estimateAffinePartial2D(
        corners[is_found], followed[is_found], method=cv2.RANSAC, ransacReprojThreshold=_OUTLYING_PX
    )
    if now_from_before is None or float(np.abs(now_from_before[:, 2]).max()) > _MOST_SHIFT_PX:
        return picture
    size = (onto.shape[1], onto.shape[0])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    moved = cv2.warpAffine(picture, now_from_before, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(moved, dtype=np.uint8)
