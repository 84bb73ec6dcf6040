"""How the surroundings of a place moved from one picture to the next: corners, KLT forth and back, a
similarity.

Source: Shi and Tomasi 1994; Kalal, Mikolajczyk and Matas, "Forward-backward error", ICPR 2010.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.vision.image_io import Gray
from tapreach.vision.warp import Warp

Points = NDArray[np.float32]
"""(n, 2) as (u, v)."""

_WINDOW = (21, 21)
_LEVELS = 4
_CRITERIA = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 20, 0.02)
_FORTH_AND_BACK = 0.8
_CORNERS = 36
_LEAST_AGREEING = 5


@dataclass(frozen=True, eq=False)
class Motion:
    """What moved how: `now_from_before` maps pixels of the earlier picture to the later one."""

    now_from_before: Warp
    agreeing: Points
    """Corners (n, 2) in the later picture that move together."""


def corners_near(picture: Gray, u: float, v: float, radius: float) -> Points:
    """Return up to 36 corners (n, 2) within `radius` [px] of (u, v)."""
    height, width = picture.shape
    left, right = max(0, int(u - radius)), min(width, int(u + radius) + 1)
    top, bottom = max(0, int(v - radius)), min(height, int(v + radius) + 1)
    if right - left < 5 or bottom - top < 5:
        return np.zeros((0, 2), np.float32)
    mask = np.zeros((bottom - top, right - left), np.uint8)
    cv2.circle(mask, (round(u) - left, round(v) - top), int(radius), 255, -1)
    found = cv2.goodFeaturesToTrack(picture[top:bottom, left:right], _CORNERS, 0.01, 3, mask=mask)
    if found is None:
        return np.zeros((0, 2), np.float32)
    return np.asarray(found.reshape(-1, 2) + np.array([left, top]), dtype=np.float32)


def flow_between(before: Gray, now: Gray, points: Points, shift: tuple[float, float]) -> Motion | None:
    """Return the similarity that most of `points` (n, 2) agree on, or None when too few do.

    `shift` [px] is where they are expected to have gone.
    """
    if len(points) < _LEAST_AGREEING:
        return None
    start = points.reshape(-1, 1, 2)
    forth = _follow(before, now, start, start + np.array(shift, dtype=np.float32))
    back = _follow(now, before, forth[0], start.copy())
    gap = np.linalg.norm(back[0] - start, axis=2).ravel()
    is_kept = forth[1] & back[1] & (gap < _FORTH_AND_BACK)
    return _agreed(points[is_kept], forth[0].reshape(-1, 2)[is_kept])


def _follow(before: Gray, now: Gray, points: Points, guess: Points) -> tuple[Points, NDArray[np.bool_]]:
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        before,
        now,
        points,
        guess.astype(np.float32),
        winSize=_WINDOW,
        maxLevel=_LEVELS,
        criteria=_CRITERIA,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )
    return np.asarray(found, dtype=np.float32), status.ravel() > 0


def _agreed(before: Points, now: Points) -> Motion | None:
    if len(before) < _LEAST_AGREEING:
        return None
    similarity, inliers = cv2.estimateAffinePartial2D(
        before, now, method=cv2.RANSAC, ransacReprojThreshold=1.0, maxIters=200
    )
    if similarity is None or int(inliers.sum()) < _LEAST_AGREEING:
        return None
    return Motion(np.asarray(similarity, dtype=np.float64), now[inliers.ravel() > 0])
