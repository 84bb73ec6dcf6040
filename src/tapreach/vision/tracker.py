"""Follows a tapped place through pictures, and says when it cannot.

From picture to picture the surroundings carry the place along (KLT); in every picture it is then fitted to
the patch as it was tapped, so that errors do not add up. Where the tapped look is gone (seen from nearer,
or from the side) a look taken on the way stands in, and its own uncertainty is added. What lies beside the
band of the caller's guesses is not the place, however alike it looks. A place that was lost is searched for
in that band, or around where it was last seen.
"""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize, Pixel, require_inside
from tapreach.vision.band import Band
from tapreach.vision.flow import Motion, Points, corners_near, flow_between
from tapreach.vision.image_io import Gray
from tapreach.vision.look import Fit, Look, context_score, fit_look, later_look, tapped_look
from tapreach.vision.patch import cut_patch
from tapreach.vision.search import find_again, rival_distance
from tapreach.vision.track import Guess, Track, TrackStatus
from tapreach.vision.warp import Warp, calmed, chained, scale_of, warp_at

_GOOD_SCORE = 0.80
_SURE_SCORE = 0.90
_LEAST_SCORE = 0.70
_LEAST_SUPPORT = 0.35
_APART_FROM_SURROUNDINGS = 2.5
"""A place that moves this far apart from its surroundings is doubted [px of the tapped frame]."""
_NEW_LOOK_SCALE = 1.25
_TAPPED_IS_BETTER = 8.0
"""The tapped look is preferred to a later one that is nearer in scale by less than this factor."""
_FOUND_SCORE, _LEAST_CONTEXT = 0.85, 0.4
"""A place found again must look so much like the patch, and its wider surroundings so much like theirs."""
_SHORT = 70.0
"""A band so short [px] leaves little else to mistake the place for."""
_MOST_LOOKS = 10
_UNSURE_SIGMA, _MOST_SIGMA = 2.0, 8.0
"""A place known worse than this is doubted, or lost [px of the tapped frame]."""
_POINTS_WANTED = 14


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
        self._radius = patch.half * patch.step
        self._looks = [tapped_look(patch, picture)]
        self._rival = rival_distance(patch, picture)
        self._warp = warp_at(u, v)
        self._picture = picture
        self._points = self._corners()
        self._lost_for = 0
        self._must_prove = False

    def follow(self, picture: Gray, guesses: Sequence[Guess] | None = None) -> Track:
        """Return where the place is in the next picture.

        guesses: the first is the most likely one; none at all says that it is not in the picture, None that
        nothing is known. Raises InputError for a picture of another size.
        """
        if picture.shape != self._picture.shape:
            height, width = picture.shape
            raise InputError(
                f"the picture is {width} by {height} px; this place is followed in pictures of "
                f"{self._size.width} by {self._size.height} px"
            )
        if guesses is not None and not guesses:
            return self._lost("it has left the picture")
        band = Band.around(guesses, self._lost_for) if guesses else None
        if self._lost_for:
            return self._resume(picture, guesses, band)
        motion = self._motion_to(picture, guesses)
        fit = self._best(picture, self._starts(motion, guesses), band)
        return self._accept(picture, fit, motion) if fit else self._search_for(picture, guesses, band)

    def _resume(self, picture: Gray, guesses: Sequence[Guess] | None, band: Band | None) -> Track:
        """Go on where little else is possible than the place itself; else search."""
        if band is not None and band.length < _SHORT:
            fit = self._best(picture, self._starts(None, guesses), band)
            if fit is not None and _is_good(fit):
                self._must_prove = True
                return self._accept(picture, fit, None)
        return self._search_for(picture, guesses, band)

    def _motion_to(self, picture: Gray, guesses: Sequence[Guess] | None) -> Motion | None:
        shift = (0.0, 0.0)
        if guesses:
            shift = (guesses[0].u - float(self._warp[0, 2]), guesses[0].v - float(self._warp[1, 2]))
        motion = flow_between(self._picture, picture, self._points, shift)
        return (
            motion
            if motion or not guesses
            else flow_between(self._picture, picture, self._points, (0.0, 0.0))
        )

    def _starts(self, motion: Motion | None, guesses: Sequence[Guess] | None) -> Iterable[Warp]:
        if motion is not None:
            yield calmed(chained(motion.now_from_before, self._warp))
        elif not guesses:
            yield calmed(self._warp)
        if guesses:
            yield self._moved_to(guesses[0])

    def _moved_to(self, guess: Guess) -> Warp:
        ratio = guess.scale / scale_of(self._warp)
        return np.column_stack([self._warp[:, :2] * ratio, (guess.u, guess.v)])

    def _best(self, picture: Gray, starts: Iterable[Warp], band: Band | None) -> Fit | None:
        """Return the best possible fit over all starts; the first good one ends the search."""
        best: Fit | None = None
        for start in starts:
            fit = self._fit(picture, start, band)
            if fit is not None and (best is None or fit.score > best.score):
                best = fit
            if best is not None and _is_good(best):
                break
        return best

    def _fit(self, picture: Gray, start: Warp, band: Band | None) -> Fit | None:
        """Fit the looks that are near in scale, the nearest first, until one fits well."""
        best: Fit | None = None
        for look in self._by_likeness(scale_of(start))[:2]:
            fit = fit_look(look, picture, start)
            if fit is None or not _is_possible(fit) or not _is_within(band, fit):
                continue
            if best is None or fit.score > best.score:
                best = fit
            if _is_good(fit):
                break
        return _with_band(best, band)

    def _by_likeness(self, scale: float) -> list[Look]:
        first = self._looks[0]

        def unlikeness(look: Look) -> float:
            return abs(math.log(scale / look.scale)) - (math.log(_TAPPED_IS_BETTER) if look is first else 0.0)

        return sorted(self._looks, key=unlikeness)

    def _search_for(self, picture: Gray, guesses: Sequence[Guess] | None, band: Band | None) -> Track:
        self._lost_for += 1
        found = find_again(self._looks, picture, self._warp, guesses, band, self._lost_for)
        fit = self._fit(picture, found, band) if found is not None else None
        if fit is None or not self._is_proven(picture, fit, band):
            self._lost_for -= 1
            return self._lost(self._loss_reason(guesses))
        self._must_prove = True
        return self._accept(picture, fit, None)

    def _is_proven(self, picture: Gray, fit: Fit, band: Band | None) -> bool:
        """Tell whether a place found again is the one: it fits, so do its surroundings, and no look-alike
        that was there at the tap could be meant instead.
        """
        if not _is_good(fit) or fit.score < _FOUND_SCORE:
            return False
        if band is not None and not self._is_only_one(band, fit):
            return False
        return context_score(fit.look, picture, fit.warp) > _LEAST_CONTEXT

    def _is_only_one(self, band: Band, fit: Fit) -> bool:
        """Tell whether neither a look-alike nor what is beyond the picture's edge can be meant instead."""
        if math.isinf(band.half_width):
            return True
        u, v = map(float, fit.warp[:, 2])
        return band.is_inside(self._size) or band.reach_from(u, v) < self._rival * scale_of(fit.warp)

    def _lost(self, reason: str) -> Track:
        self._lost_for += 1
        return Track(TrackStatus.LOST, reason, None, 0.0, scale_of(self._warp), 0.0)

    def _loss_reason(self, guesses: Sequence[Guess] | None) -> str:
        u, v = (guesses[0].u, guesses[0].v) if guesses else (float(self._warp[0, 2]), float(self._warp[1, 2]))
        if not Pixel(u, v).is_inside(self._size):
            return "it has left the picture"
        if self.weakness:
            return f"it cannot be told from its surroundings: {self.weakness}"
        return "it is hidden, or looks too different now"

    def _accept(self, picture: Gray, fit: Fit, motion: Motion | None) -> Track:
        before, self._warp, self._picture, self._lost_for = self._warp, fit.warp, picture, 0
        self._points = motion.agreeing if motion is not None else np.zeros((0, 2), np.float32)
        if len(self._points) < _POINTS_WANTED:
            self._points = self._corners()
        sigma = fit.sigma
        if sigma > _MOST_SIGMA * max(1.0, scale_of(fit.warp)):
            reason = f"its place would be known to {sigma:.0f} px only"
            return Track(TrackStatus.LOST, reason, None, 0.0, scale_of(fit.warp), fit.score)
        reason = self._doubt(fit, sigma) or self._odd_motion(fit, before, motion) or self.weakness
        if _is_good(fit) and reason in ("", self.weakness):
            self._learn(picture, fit)
        self._must_prove = False
        status = TrackStatus.UNSURE if reason else TrackStatus.FOLLOWED
        return Track(status, reason, Pixel(*map(float, fit.warp[:, 2])), sigma, scale_of(fit.warp), fit.score)

    def _doubt(self, fit: Fit, sigma: float) -> str:
        if not Pixel(*map(float, fit.warp[:, 2])).is_inside(self._size):
            return "it is at the edge of the picture"
        if self._must_prove:
            return "it was found again and must be seen once more"
        if not _is_good(fit):
            return "it looks different from what was tapped"
        if sigma > _UNSURE_SIGMA * max(1.0, scale_of(fit.warp)):
            return f"its place is known to {sigma:.0f} px only"
        return ""

    def _odd_motion(self, fit: Fit, before: Warp, motion: Motion | None) -> str:
        if motion is None:
            return ""
        expected = chained(motion.now_from_before, before)[:, 2]
        apart = float(np.hypot(*(fit.warp[:, 2] - expected)))
        limit = _APART_FROM_SURROUNDINGS * max(1.0, scale_of(fit.warp))
        return "it moves apart from its surroundings" if apart > limit else ""

    def _learn(self, picture: Gray, fit: Fit) -> None:
        """Learn which samples move with the place; take a new look where none is near in size."""
        scale = scale_of(fit.warp)
        self._looks = [look.learned(fit.agreement) if look is fit.look else look for look in self._looks]
        nearest = min(abs(math.log(scale / look.scale)) for look in self._looks)
        if nearest > math.log(_NEW_LOOK_SCALE) and fit.score >= _SURE_SCORE:
            kept = self._looks if len(self._looks) < _MOST_LOOKS else [self._looks[0], *self._looks[2:]]
            self._looks = [*kept, later_look(picture, fit)]

    def _corners(self) -> Points:
        radius = max(12.0, 1.6 * self._radius * min(scale_of(self._warp), 2.0))
        return corners_near(self._picture, float(self._warp[0, 2]), float(self._warp[1, 2]), radius)


def _is_good(fit: Fit) -> bool:
    return fit.score >= _GOOD_SCORE and fit.support >= _LEAST_SUPPORT


def _is_possible(fit: Fit) -> bool:
    return fit.score >= _LEAST_SCORE and fit.support >= _LEAST_SUPPORT


def _is_within(band: Band | None, fit: Fit) -> bool:
    return band is None or band.holds(float(fit.warp[0, 2]), float(fit.warp[1, 2]), scale_of(fit.warp))


def _with_band(fit: Fit | None, band: Band | None) -> Fit | None:
    expected = band.expected() if band is not None else None
    return fit if fit is None or expected is None else fit.fused_with(*expected)
