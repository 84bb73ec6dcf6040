"""Finds a patch again that was lost: along the caller's guesses, or around where it was last seen."""

from collections.abc import Sequence

import cv2
import numpy as np

from tapreach.vision.image_io import Gray
from tapreach.vision.patch import Patch
from tapreach.vision.region import region_around
from tapreach.vision.track import Guess
from tapreach.vision.warp import Warp, chained, scale_of, warp_at

_LEAST_PEAK = 0.80
_CLEARLY = 0.08
_FIRST_REACH = 14
_MOST_REACH = 60
_GUESS_REACH = 14
_SCALES = (1.0, 0.87, 1.15)


def find_again(
    patch: Patch, picture: Gray, last: Warp, guesses: Sequence[Guess], lost_for: int
) -> Warp | None:
    """Return a warp from `patch` to where it most likely is, None when there is no clear peak.

    last: the warp when it was last seen. lost_for: pictures since then; the search grows with it. A second
    place that looks nearly as good, away from the best one, makes the answer None: two alike are no answer.
    """
    peaks = [
        peak
        for start, reach in _places(last, guesses, lost_for)
        for peak in _peaks(patch, picture, start, reach)
    ]
    if not peaks:
        return None
    best_score, best = max(peaks, key=lambda peak: peak[0])
    apart = patch.half * scale_of(best)
    rivals = [score for score, warp in peaks if float(np.hypot(*(warp[:, 2] - best[:, 2]))) > apart]
    if best_score < _LEAST_PEAK or best_score - max(rivals, default=-1.0) < _CLEARLY:
        return None
    return best


def _places(last: Warp, guesses: Sequence[Guess], lost_for: int) -> list[tuple[Warp, int]]:
    if guesses:
        return [(_placed(last, guess.u, guess.v, guess.scale), _GUESS_REACH) for guess in guesses]
    reach = min(_MOST_REACH, _FIRST_REACH + 4 * lost_for)
    u, v, scale = float(last[0, 2]), float(last[1, 2]), scale_of(last)
    return [(_placed(last, u, v, scale * factor), reach) for factor in _SCALES]


def _placed(last: Warp, u: float, v: float, scale: float) -> Warp:
    return np.column_stack([last[:, :2] * (scale / scale_of(last)), (u, v)])


def _peaks(patch: Patch, picture: Gray, start: Warp, reach: int) -> list[tuple[float, Warp]]:
    """Return the best place within `reach` patch pixels of `start`, and the best one away from it."""
    reach = max(4, round(reach / scale_of(start)))
    seen = region_around(picture, start, patch.half + reach).sample(start, patch.half + reach)
    scores = cv2.matchTemplate(seen, patch.values, cv2.TM_CCOEFF_NORMED)
    found = []
    for _ in range(2):
        row, column = np.unravel_index(int(np.argmax(scores)), scores.shape)
        score = float(scores[row, column])
        found.append((score, chained(start, warp_at(float(column) - reach, float(row) - reach))))
        near = slice(max(0, int(row) - patch.half), int(row) + patch.half + 1)
        scores[near, max(0, int(column) - patch.half) : int(column) + patch.half + 1] = -1.0
    return found
