"""Follows a tapped place through pictures, and says when it cannot.

From picture to picture the surroundings carry the place along (KLT); in every picture it is then fitted to
the patch as it was tapped, so that errors do not add up. Where the tapped look is gone (seen from nearer,
or from the side) a look taken on the way stands in, and its own uncertainty is added. A place that was lost
is searched for along the caller's guesses, or around where it was last seen.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize, Pixel, require_inside
from tapreach.vision.align import Alignment, align
from tapreach.vision.flow import Motion, Points, corners_near, flow_between
from tapreach.vision.image_io import Gray
from tapreach.vision.patch import Patch, cut_patch, patch_of_half
from tapreach.vision.search import find_again
from tapreach.vision.track import Guess, Track, TrackStatus
from tapreach.vision.warp import Warp, calmed, chained, inverted, scale_of, warp_at

_GOOD_SCORE = 0.80
_SURE_SCORE = 0.90
_LEAST_SCORE = 0.70
_LEAST_SUPPORT = 0.35
_SEARCH = 4
_LEAST_SIGMA = 0.35
_SIGMA_PER_LOG_SCALE = 1.2
"""A place seen from nearer or farther looks different: so much is added per factor e [px of the tapped
frame].
"""
_APART_FROM_SURROUNDINGS = 2.5
"""A place that moves this far apart from its surroundings is doubted [px of the tapped frame]."""
_NEW_LOOK_SCALE = 1.25
_MOST_SIGMA = 4.0
_POINTS_WANTED = 14


@dataclass(frozen=True, eq=False)
class _Look:
    """A patch to compare with: the tapped one, or one taken later.

    tapped_from_patch: its warp against the tapped patch. variance: of its centre against the tapped one [px²
    of the tapped frame].
    """

    patch: Patch
    tapped_from_patch: Warp
    variance: float


@dataclass(frozen=True, eq=False)
class _Fit:
    """The place in the present picture: warp from the tapped patch, variance [px²], score, support,
    and by which look.
    """

    warp: Warp
    variance: float
    score: float
    support: float
    is_tapped_look: bool

    @property
    def is_good(self) -> bool:
        return self.score >= _GOOD_SCORE and self.support >= _LEAST_SUPPORT

    @property
    def is_possible(self) -> bool:
        return self.score >= _LEAST_SCORE and self.support >= _LEAST_SUPPORT


class PatchTracker:
    """Follows the place at (u, v) of a first picture. Feed it pictures in the order of time, with `follow`.

    Raises InputError for a pixel outside the picture. All pictures must be of one size.
    """

    def __init__(self, picture: Gray, u: float, v: float) -> None:
        height, width = picture.shape
        self._size = ImageSize(width, height)
        require_inside(Pixel(u, v), self._size)
        patch = cut_patch(picture, u, v)
        self.weakness = patch.weakness
        """Why the place will be hard to follow; '' when it will not."""
        self._tapped = _Look(patch, warp_at(0.0, 0.0), 0.0)
        self._later: _Look | None = None
        self._warp = patch.picture_from_patch
        self._picture = picture
        self._points = self._corners()
        self._lost_for = 0
        self._must_prove = False

    def follow(self, picture: Gray, guesses: Sequence[Guess] = ()) -> Track:
        """Return where the place is in the next picture.

        The first of `guesses` is the most likely one. Raises InputError for a picture of another size.
        """
        if picture.shape != self._picture.shape:
            height, width = picture.shape
            raise InputError(
                f"the picture is {width} by {height} px; this place is followed in pictures of "
                f"{self._size.width} by {self._size.height} px"
            )
        motion = None if self._lost_for else self._motion_to(picture, guesses)
        fit = self._best(picture, self._starts(motion, guesses))
        if fit is None or not fit.is_possible:
            return self._search_for(picture, guesses)
        return self._accept(picture, fit, motion)

    def _motion_to(self, picture: Gray, guesses: Sequence[Guess]) -> Motion | None:
        shift = (0.0, 0.0)
        if guesses:
            shift = (guesses[0].u - float(self._warp[0, 2]), guesses[0].v - float(self._warp[1, 2]))
        motion = flow_between(self._picture, picture, self._points, shift)
        return (
            motion
            if motion or not guesses
            else flow_between(self._picture, picture, self._points, (0.0, 0.0))
        )

    def _starts(self, motion: Motion | None, guesses: Sequence[Guess]) -> Iterable[Warp]:
        if motion is not None:
            yield calmed(chained(motion.now_from_before, self._warp))
        elif not self._lost_for:
            yield calmed(self._warp)
        if guesses:
            yield self._moved_to(guesses[0])

    def _moved_to(self, guess: Guess) -> Warp:
        ratio = guess.scale / scale_of(self._warp)
        return np.column_stack([self._warp[:, :2] * ratio, (guess.u, guess.v)])

    def _best(self, picture: Gray, starts: Iterable[Warp]) -> _Fit | None:
        """Return the best fit over all starts; the first good one ends the search."""
        best: _Fit | None = None
        for start in starts:
            fit = self._fit(picture, start)
            if fit is not None and (best is None or fit.score > best.score):
                best = fit
            if best is not None and best.is_good:
                break
        return best

    def _fit(self, picture: Gray, start: Warp) -> _Fit | None:
        """Fit the tapped look; where it no longer fits well, the later look."""
        tapped = _fit_look(self._tapped, picture, start, is_tapped_look=True)
        if self._later is None or (tapped is not None and tapped.is_good):
            return tapped
        later = _fit_look(self._later, picture, start, is_tapped_look=False)
        if later is None or (tapped is not None and tapped.score >= later.score):
            return tapped
        return later

    def _search_for(self, picture: Gray, guesses: Sequence[Guess]) -> Track:
        self._lost_for += 1
        found = find_again(self._tapped.patch, picture, self._warp, guesses, self._lost_for)
        fit = self._fit(picture, found) if found is not None else None
        if fit is None or not fit.is_good or fit.score < _SURE_SCORE:
            return Track(TrackStatus.LOST, self._loss_reason(guesses), None, 0.0, scale_of(self._warp), 0.0)
        self._must_prove = True
        return self._accept(picture, fit, None)

    def _loss_reason(self, guesses: Sequence[Guess]) -> str:
        u, v = (guesses[0].u, guesses[0].v) if guesses else (float(self._warp[0, 2]), float(self._warp[1, 2]))
        if not Pixel(u, v).is_inside(self._size):
            return "it has left the picture"
        if self.weakness:
            return f"it cannot be told from its surroundings: {self.weakness}"
        return "it is hidden, or looks too different now"

    def _accept(self, picture: Gray, fit: _Fit, motion: Motion | None) -> Track:
        before, self._warp, self._picture, self._lost_for = self._warp, fit.warp, picture, 0
        self._points = motion.agreeing if motion is not None else np.zeros((0, 2), np.float32)
        if len(self._points) < _POINTS_WANTED:
            self._points = self._corners()
        sigma = math.sqrt(fit.variance)
        reason = self._doubt(fit, sigma) or self._odd_motion(fit, before, motion) or self.weakness
        if fit.is_good and reason in ("", self.weakness):
            self._renew_look(picture, fit)
        self._must_prove = False
        status = TrackStatus.UNSURE if reason else TrackStatus.FOLLOWED
        return Track(status, reason, Pixel(*map(float, fit.warp[:, 2])), sigma, scale_of(fit.warp), fit.score)

    def _doubt(self, fit: _Fit, sigma: float) -> str:
        if not Pixel(*map(float, fit.warp[:, 2])).is_inside(self._size):
            return "it is at the edge of the picture"
        if self._must_prove:
            return "it was found again and must be seen once more"
        if not fit.is_good:
            return "it looks different from what was tapped"
        if sigma > _MOST_SIGMA:
            return f"its place is known to {sigma:.0f} px only"
        return ""

    def _odd_motion(self, fit: _Fit, before: Warp, motion: Motion | None) -> str:
        if motion is None:
            return ""
        expected = chained(motion.now_from_before, before)[:, 2]
        apart = float(np.hypot(*(fit.warp[:, 2] - expected)))
        limit = _APART_FROM_SURROUNDINGS * max(1.0, scale_of(fit.warp))
        return "it moves apart from its surroundings" if apart > limit else ""

    def _renew_look(self, picture: Gray, fit: _Fit) -> None:
        """Take a new look when the tapped one will soon be too different in size."""
        base = scale_of(self._later.tapped_from_patch) if self._later is not None else 1.0
        change = scale_of(fit.warp) * base
        if 1.0 / _NEW_LOOK_SCALE < change < _NEW_LOOK_SCALE or fit.score < _SURE_SCORE:
            return
        now = warp_at(float(fit.warp[0, 2]), float(fit.warp[1, 2]))
        patch = patch_of_half(picture, now, self._tapped.patch.half)
        tapped_from_now = chained(inverted(fit.warp), now)
        self._later = _Look(patch, tapped_from_now, fit.variance / scale_of(fit.warp) ** 2)

    def _corners(self) -> Points:
        radius = max(12.0, 1.6 * self._tapped.patch.half * min(scale_of(self._warp), 2.0))
        return corners_near(self._picture, float(self._warp[0, 2]), float(self._warp[1, 2]), radius)


def _fit_look(look: _Look, picture: Gray, start: Warp, is_tapped_look: bool) -> _Fit | None:
    found: Alignment | None = align(look.patch, picture, chained(start, look.tapped_from_patch), _SEARCH)
    if found is None:
        return None
    warp = chained(found.warp, inverted(look.tapped_from_patch))
    change = _SIGMA_PER_LOG_SCALE * math.log(scale_of(found.warp))
    noise = float(np.trace(found.covariance)) / 2.0 + _LEAST_SIGMA**2
    variance = noise + scale_of(warp) ** 2 * (look.variance + change**2)
    return _Fit(warp, variance, found.score, found.support, is_tapped_look)
