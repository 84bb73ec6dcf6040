"""Finds a place again that was lost: along the caller's guesses, or around where it was last seen."""

import math
from collections.abc import Sequence

import cv2
import numpy as np

from tapreach.vision.band import Band
from tapreach.vision.image_io import Gray
from tapreach.vision.look import Look
from tapreach.vision.patch import Patch
from tapreach.vision.region import region_around
from tapreach.vision.track import Guess
from tapreach.vision.warp import Warp, chained, inverted, scale_of, warp_at

_LEAST_PEAK = 0.65
_CLEARLY = 0.06
_FIRST_REACH = 14
_MOST_REACH = 60
_LEAST_GUESS_REACH = 8
_RIVAL_REACH, _RIVAL_SCORE = 70, 0.6
"""How far around the tapped place look-alikes are sought [samples], and how alike they are."""
_MOST_PLACES = 5
"""So many places are searched in one picture at most, the likeliest first: it must not take long."""
_MOST_LOG_SCALE = 1.2
"""A place is not sought at a size farther than this from where it was last seen."""
_SCALES = (1.0, 0.87, 1.15)


def find_again(
    looks: Sequence[Look],
    picture: Gray,
    last: Warp,
    guesses: Sequence[Guess] | None,
    band: Band | None,
    lost_for: int,
) -> Warp | None:
    """Return the warp from the tapped patch to where it most likely is, None when there is no clear peak.

    last: the warp when it was last seen. lost_for: pictures since then; the search grows with it. A second
    place that looks nearly as good, away from the best one, makes the answer None: two alike are no answer.
    """
    peaks = [
        peak
        for start, reach in _places(picture, last, guesses, band, lost_for)
        for peak in _peaks(nearest_look(looks, scale_of(start)), picture, start, reach, band)
    ]
    if not peaks:
        return None
    best_score, best = max(peaks, key=lambda peak: peak[0])
    apart = looks[0].patch.half * looks[0].patch.step * scale_of(best)
    rivals = [score for score, warp in peaks if float(np.hypot(*(warp[:, 2] - best[:, 2]))) > apart]
    if best_score < _LEAST_PEAK or best_score - max(rivals, default=-1.0) < _CLEARLY:
        return None
    return best


def rival_distance(patch: Patch, picture: Gray) -> float:
    """Return how far the nearest place is that looks like `patch` in its picture [px]; infinite for none."""
    reach = patch.half + _RIVAL_REACH
    seen = region_around(picture, patch.picture_from_patch, reach).sample(patch.picture_from_patch, reach)
    scores = cv2.matchTemplate(seen, patch.values, cv2.TM_CCOEFF_NORMED)
    middle = _RIVAL_REACH
    is_peak = (scores == cv2.dilate(scores, np.ones((5, 5), np.uint8))) & (scores > _RIVAL_SCORE)
    rows, columns = np.nonzero(is_peak)
    away = np.hypot(rows - middle, columns - middle) * patch.step
    others = away[away > 4.0 * patch.step]
    return float(others.min()) if others.size else math.inf


def nearest_look(looks: Sequence[Look], scale: float) -> Look:
    """Return the look that was taken nearest to `scale`."""
    return min(looks, key=lambda look: abs(math.log(scale / look.scale)))


def _places(
    picture: Gray, last: Warp, guesses: Sequence[Guess] | None, band: Band | None, lost_for: int
) -> list[tuple[Warp, int]]:
    """Return where to look and how far around [px]."""
    if guesses and band is not None:
        reach = _FIRST_REACH if math.isinf(band.half_width) else round(band.half_width)
        reach = min(max(reach, _LEAST_GUESS_REACH), _MOST_REACH)
        height, width = picture.shape
        near = [
            guess
            for guess in guesses
            if -reach < guess.u < width + reach
            and -reach < guess.v < height + reach
            and abs(math.log(guess.scale / scale_of(last))) < _MOST_LOG_SCALE
        ]
        return [(_placed(last, *place), reach) for place in _thinned(near, 0.7 * reach)[:_MOST_PLACES]]
    reach = min(_MOST_REACH, _FIRST_REACH + 4 * lost_for)
    u, v, scale = float(last[0, 2]), float(last[1, 2]), scale_of(last)
    return [(_placed(last, u, v, scale * factor), reach) for factor in _SCALES]


def _thinned(guesses: Sequence[Guess], apart: float) -> list[tuple[float, float, float]]:
    """Leave out guesses that a kept one covers: as near as `apart` [px] and of like scale."""
    kept: list[tuple[float, float, float]] = []
    for guess in guesses:
        if all(
            math.hypot(guess.u - u, guess.v - v) > apart or abs(math.log(guess.scale / scale)) > 0.12
            for u, v, scale in kept
        ):
            kept.append((guess.u, guess.v, guess.scale))
    return kept


def _placed(last: Warp, u: float, v: float, scale: float) -> Warp:
    return np.column_stack([last[:, :2] * (scale / scale_of(last)), (u, v)])


def _peaks(look: Look, picture: Gray, start: Warp, reach: int, band: Band | None) -> list[tuple[float, Warp]]:
    """Return the best place within `reach` [px] of `start`, and the best one away from it."""
    half = look.patch.half
    begin = chained(start, look.tapped_from_patch)
    reach = min(max(4, round(reach / scale_of(begin))), _MOST_REACH)
    seen = region_around(picture, begin, half + reach).sample(begin, half + reach)
    scores = cv2.matchTemplate(seen, look.patch.values, cv2.TM_CCOEFF_NORMED)
    back = inverted(look.tapped_from_patch)
    found = []
    for _ in range(2):
        row, column = np.unravel_index(int(np.argmax(scores)), scores.shape)
        score = float(scores[row, column])
        warp = chained(chained(begin, warp_at(float(column) - reach, float(row) - reach)), back)
        if band is None or band.holds(float(warp[0, 2]), float(warp[1, 2])):
            found.append((score, warp))
        near = slice(max(0, int(row) - half), int(row) + half + 1)
        scores[near, max(0, int(column) - half) : int(column) + half + 1] = -1.0
    return found
