"""How the surroundings of a place moved from one picture to the next: corners, KLT forth and back, and the
two similarities that most of them agree on. Things before and behind each other move differently.

Source: Shi and Tomasi 1994; Kalal, Mikolajczyk and Matas, "Forward-backward error", ICPR 2010.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.vision.cut_out import cut_around
from tapreach.vision.image_io import Gray
from tapreach.vision.warp import Warp

Points = NDArray[np.float32]
"""(n, 2) as (u, v)."""

_WINDOW = (21, 21)
_LEVELS = 4
_CRITERIA = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 20, 0.02)
NEAR, FAR = 48, 200
"""Room around the corners [px] for the window, and for what moves otherwise than expected."""
_FORTH_AND_BACK = 0.8
_CORNERS = 36
_LEAST_AGREEING = 5
_MOST_MOTIONS = 2
_CORNER_NOISE, _MOST_APART = 0.12, 6.0
"""What a corner is followed to, one sigma, and beyond which it has jumped [px]."""


@dataclass(frozen=True, eq=False)
class Motion:
    """What moved how: `now_from_before` maps pixels of the earlier picture to the later one."""

    now_from_before: Warp
    agreeing: Points
    """Corners (n, 2) in the later picture that move together."""
    disagreement: FloatArray
    """(2, 2) [px²]: mean square of how all corners near the place moved differently, noise taken off."""


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


def motions_between(
    before: Gray, now: Gray, points: Points, shift: tuple[float, float], room: int = NEAR
) -> tuple[Motion, ...]:
    """Return the similarities that most of `points` (n, 2) agree on, the one with most of them first: at
    most two, none when too few agree.

    `shift` [px] is where they are expected to have gone, give or take about `room` [px].
    """
    if len(points) < _LEAST_AGREEING:
        return ()
    left, gone = _followed(before, now, points, shift, room)
    every, motions = (left, gone), list[Motion]()
    while len(motions) < _MOST_MOTIONS:
        found = _agreed(left, gone)
        if found is None:
            break
        warp, inliers = found
        motions.append(Motion(warp, gone[inliers], _disagreement(warp, *every)))
        left, gone = left[~inliers], gone[~inliers]
    return tuple(motions)


def _followed(
    before: Gray, now: Gray, points: Points, shift: tuple[float, float], room: int
) -> tuple[Points, Points]:
    """Return those of `points` (n, 2) that are followed forth and back, and where they have gone."""
    part = cut_around(before, now, points, shift, room)
    if part is None:
        return points[:0], points[:0]
    start = points - part.before_at
    # What the parts were moved by is most of the shift; the rest is below a pixel.
    forth, is_found = carried(part.before, part.now, start, start, _WINDOW, _LEVELS, _CRITERIA)
    back, is_back = carried(part.now, part.before, forth, start, _WINDOW, _LEVELS, _CRITERIA)
    is_kept = is_found & is_back & (np.linalg.norm(back - start, axis=1) < _FORTH_AND_BACK)
    return points[is_kept], forth[is_kept] + part.now_at


def _disagreement(warp: Warp, before: Points, now: Points) -> FloatArray:
    apart = (before @ warp[:, :2].T + warp[:, 2] - now).astype(np.float64)
    length = np.maximum(np.linalg.norm(apart, axis=1, keepdims=True), 1e-9)
    apart *= np.minimum(_MOST_APART / length, 1.0)
    values, axes = np.linalg.eigh(apart.T @ apart / len(apart) - _CORNER_NOISE**2 * np.eye(2))
    return np.asarray((axes * np.maximum(values, 0.0)) @ axes.T)


def carried(
    before: Gray,
    now: Gray,
    points: Points,
    guess: Points,
    window: tuple[int, int],
    levels: int,
    criteria: tuple[int, int, float],
) -> tuple[Points, NDArray[np.bool_]]:
    """Return where `points` (n, 2) have gone by KLT, starting from `guess`; and (n,) which were found."""
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        before,
        now,
        points,
        guess.astype(np.float32),
        winSize=window,
        maxLevel=levels,
        criteria=criteria,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )
    return np.asarray(found, dtype=np.float32), np.asarray(status.ravel() > 0)


def _agreed(before: Points, now: Points) -> tuple[Warp, NDArray[np.bool_]] | None:
    if len(before) < _LEAST_AGREEING:
        return None
    similarity, inliers = cv2.estimateAffinePartial2D(
        before, now, method=cv2.RANSAC, ransacReprojThreshold=1.0, maxIters=200
    )
    if similarity is None or int(inliers.sum()) < _LEAST_AGREEING:
        return None
    return np.asarray(similarity, dtype=np.float64), inliers.ravel() > 0
