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
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize, Pixel, require_inside
from tapreach.vision.band import Band
from tapreach.vision.carried import Start, carried, conflict, joined
from tapreach.vision.core import looseness, seen_from_elsewhere
from tapreach.vision.flow import FAR, Motion, Points, corners_near, motions_between
from tapreach.vision.image_io import Gray
from tapreach.vision.look import Fit, Look, context_score, fit_look, later_look, tapped_look
from tapreach.vision.patch import cut_patch
from tapreach.vision.search import find_again, rival_distance
from tapreach.vision.track import Guess, Track, TrackStatus
from tapreach.vision.warp import Warp, calmed, scale_of, warp_at

_GOOD_SCORE = 0.80
_SURE_SCORE = 0.90
_LEAST_SCORE = 0.70
_LEAST_SUPPORT = 0.35
_NEW_LOOK_SCALE = 1.25
_TAPPED_IS_BETTER = 8.0
"""The tapped look is preferred to a later one that is nearer in scale by less than this factor."""
_FOUND_SCORE, _LEAST_CONTEXT = 0.85, 0.4
"""A place found again must look so much like the patch, and its wider surroundings so much like theirs."""
_SHORT = 70.0
"""A band so short [px] leaves little else to mistake the place for."""
_MOST_LOOKS = 10
_UNSURE_SIGMA, _MOST_SIGMA = 2.0, 40.0
"""A place known worse than this is doubted, or lost [px of the tapped frame]."""
_CARRIED_SCORE, _MOST_CARRIED, _CARRIED_SIGMA = 0.4, 8, 0.5
"""A place whose look fits no worse than this is carried along by its surroundings for so many pictures at
most; each adds so much [px of the tapped frame].
"""
_CARRIED_APART = 2.0
"""Surroundings that move farther apart in one picture cannot carry it [px of the tapped frame]."""
_RESUMED_SIGMA = 0.5
"""How well a place is known from which the caller has it go on [px]."""
_MOST_FITS = 3
"""So many looks are fitted in one picture, and one more to a place found again: it must not take long."""
_DOUBTED = 2.0
"""The sigma of a doubtful place counts so many times."""
_LEAST_AROUND, _MOST_AROUND = 26.0, 60.0
"""Radius [px] around the place in which corners are followed."""


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
        self._own = np.zeros((2, 2))
        self._loose = looseness(picture, u, v)
        self._points = self._corners()
        self._lost_for = self._carried_for = 0
        self._must_prove = False
        self._fits_left = _MOST_FITS

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
        self._fits_left = _MOST_FITS
        if guesses is not None and not guesses:
            return self._lost("it has left the picture")
        band = Band.around(guesses, self._lost_for) if guesses else None
        if self._lost_for:
            return self._resume(picture, guesses, band)
        motions = self._motions_to(picture, guesses)
        along = carried(motions, self._warp, self._own)
        starts = [*along, *self._other_starts(motions, guesses)]
        fit, poor = self._best(picture, starts, band)
        if fit is not None:
            return self._accept(picture, *fit)
        if poor is not None and self._is_carried(*poor, along, band):
            return self._carry(picture, *poor)
        return self._search_for(picture, guesses, band)

    def resume(self, picture: Gray, warp: Warp, layer: FloatArray) -> None:
        """Go on from where the caller has found the place in the picture just followed.

        warp: (2, 3) from the tapped patch. layer: (n²,) how surely each of its samples moves with the place,
        0 to 1; of another size than the patch that is followed it is left out. Looks taken since are
        forgotten: they may be of something else.
        """
        tapped = self._looks[0]
        if layer.shape == tapped.layer.shape:
            tapped = tapped.with_layer(layer)
        self._looks = [tapped]
        self._carried_for, self._must_prove = 0, False
        self._move_to(picture, warp, _RESUMED_SIGMA**2 * np.eye(2))

    def _resume(self, picture: Gray, guesses: Sequence[Guess] | None, band: Band | None) -> Track:
        """Go on where little else is possible than the place itself; else search."""
        if band is not None and band.length < _SHORT:
            found, _ = self._best(picture, self._other_starts((), guesses), band)
            if found is not None and _is_good(found[0]):
                self._must_prove = True
                return self._accept(picture, *found)
        return self._search_for(picture, guesses, band)

    def _motions_to(self, picture: Gray, guesses: Sequence[Guess] | None) -> tuple[Motion, ...]:
        shift = (0.0, 0.0)
        if guesses:
            shift = (guesses[0].u - float(self._warp[0, 2]), guesses[0].v - float(self._warp[1, 2]))
        motions = motions_between(self._picture, picture, self._points, shift)
        if motions or not guesses:
            return motions
        return motions_between(self._picture, picture, self._points, shift, FAR)

    def _other_starts(self, motions: Sequence[Motion], guesses: Sequence[Guess] | None) -> list[Start]:
        starts = [] if motions or guesses else [Start(calmed(self._warp), None)]
        return [*starts, *([Start(self._moved_to(guesses[0]), None)] if guesses else [])]

    def _moved_to(self, guess: Guess) -> Warp:
        ratio = guess.scale / scale_of(self._warp)
        return np.column_stack([self._warp[:, :2] * ratio, (guess.u, guess.v)])

    def _best(
        self, picture: Gray, starts: Sequence[Start], band: Band | None
    ) -> tuple[tuple[Fit, Start] | None, tuple[Fit, Start] | None]:
        """Return the best possible fit over all starts, and the best of those that are too bad, each with the
        start it was found from; the first good one ends the search.
        """
        best: tuple[Fit, Start] | None = None
        poor: tuple[Fit, Start] | None = None
        for start in starts:
            for fit in self._fits(picture, start.warp, band):
                if not _is_possible(fit):
                    if start.covariance is not None and (poor is None or fit.score > poor[0].score):
                        poor = fit, start
                elif best is None or fit.score > best[0].score:
                    best = fit, start
            if best is not None and _is_good(best[0]):
                break
        return best, poor

    def _fits(self, picture: Gray, start: Warp, band: Band | None) -> Iterable[Fit]:
        """Fit the looks that are near in scale, the nearest first, until one fits well."""
        for look in self._by_likeness(scale_of(start))[:2]:
            if self._fits_left <= 0:
                return
            self._fits_left -= 1
            fit = fit_look(look, picture, start)
            if fit is not None and _is_within(band, fit):
                yield _with_band(fit, band)
                if _is_good(fit):
                    return

    def _fit(self, picture: Gray, start: Warp, band: Band | None) -> Fit | None:
        """Return the best possible fit near `start`."""
        possible = filter(_is_possible, self._fits(picture, start, band))
        return max(possible, key=lambda fit: fit.score, default=None)

    def _by_likeness(self, scale: float) -> list[Look]:
        first = self._looks[0]

        def unlikeness(look: Look) -> float:
            return abs(math.log(scale / look.scale)) - (math.log(_TAPPED_IS_BETTER) if look is first else 0.0)

        return sorted(self._looks, key=unlikeness)

    def _search_for(self, picture: Gray, guesses: Sequence[Guess] | None, band: Band | None) -> Track:
        self._lost_for += 1
        self._fits_left = max(self._fits_left, 1)
        found = find_again(self._looks, picture, self._warp, guesses, band, self._lost_for)
        fit = self._fit(picture, found, band) if found is not None else None
        if fit is None or not self._is_proven(picture, fit, band):
            self._lost_for -= 1
            return self._lost(self._loss_reason(guesses))
        self._must_prove = True
        return self._accept(picture, fit, Start(fit.warp, None))

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

    def _accept(self, picture: Gray, found: Fit, start: Start) -> Track:
        is_odd = conflict(found, start)
        fit = found if is_odd else joined(found, start)
        self._move_to(picture, fit.warp, fit.own)
        self._carried_for = 0
        sigma = self._sigma(fit.warp, fit.covariance)
        if sigma > _MOST_SIGMA * max(1.0, scale_of(fit.warp)):
            reason = f"its place would be known to {sigma:.0f} px only"
            return Track(TrackStatus.LOST, reason, None, 0.0, scale_of(fit.warp), fit.score)
        doubt = self._doubt(fit) or ("it moves apart from its surroundings" if is_odd else "")
        reason = doubt or _vagueness(sigma, fit.warp) or self.weakness
        if _is_good(fit) and reason in ("", self.weakness):
            self._learn(picture, fit)
        self._must_prove = False
        status = TrackStatus.UNSURE if reason else TrackStatus.FOLLOWED
        sigma *= _DOUBTED if doubt else 1.0
        return Track(status, reason, Pixel(*map(float, fit.warp[:, 2])), sigma, scale_of(fit.warp), fit.score)

    def _is_carried(self, fit: Fit, start: Start, along: Sequence[Start], band: Band | None) -> bool:
        """Tell whether a look that does not fit may be due to what it is, and not to what hides it: what
        slides in front of it moves otherwise than its surroundings, and than the robot makes it move.
        """
        apart = float(np.linalg.norm(along[0].warp[:, 2] - along[-1].warp[:, 2]))
        is_one = apart < _CARRIED_APART * max(1.0, scale_of(along[0].warp))
        is_expected = band is not None and band.holds(*map(float, start.warp[:, 2]))
        return is_one and is_expected and self._carried_for < _MOST_CARRIED and fit.score > _CARRIED_SCORE

    def _carry(self, picture: Gray, fit: Fit, start: Start) -> Track:
        """Go where the surroundings go."""
        assert start.covariance is not None
        scale = scale_of(start.warp)
        own = start.covariance + (_CARRIED_SIGMA * scale) ** 2 * np.eye(2)
        self._move_to(picture, start.warp, own)
        self._carried_for += 1
        pixel = Pixel(*map(float, start.warp[:, 2]))
        sigma = _DOUBTED * self._sigma(start.warp, own + fit.inherited)
        reason = "it looks different from what was tapped"
        return Track(TrackStatus.UNSURE, reason, pixel, sigma, scale, fit.score)

    def _sigma(self, warp: Warp, covariance: FloatArray) -> float:
        """Return one sigma [px] of a place found with `covariance` (2, 2) [px²]."""
        return seen_from_elsewhere(covariance, warp, self._loose)

    def _move_to(self, picture: Gray, warp: Warp, own: FloatArray) -> None:
        self._warp, self._own, self._picture, self._lost_for = warp, own, picture, 0
        self._points = self._corners()

    def _doubt(self, fit: Fit) -> str:
        if not Pixel(*map(float, fit.warp[:, 2])).is_inside(self._size):
            return "it is at the edge of the picture"
        if self._must_prove:
            return "it was found again and must be seen once more"
        if not _is_good(fit):
            return "it looks different from what was tapped"
        return ""

    def _learn(self, picture: Gray, fit: Fit) -> None:
        """Learn which samples move with the place; take a new look where none is near in size."""
        scale = scale_of(fit.warp)
        self._looks = [look.learned(fit.agreement) if look is fit.look else look for look in self._looks]
        nearest = min(abs(math.log(scale / look.scale)) for look in self._looks)
        if nearest > math.log(_NEW_LOOK_SCALE) and fit.score >= _SURE_SCORE:
            kept = self._looks if len(self._looks) < _MOST_LOOKS else [self._looks[0], *self._looks[2:]]
            self._looks = [*kept, later_look(picture, fit)]

    def _corners(self) -> Points:
        radius = 1.6 * self._radius * min(scale_of(self._warp), 2.0)
        radius = min(max(radius, _LEAST_AROUND), _MOST_AROUND)
        return corners_near(self._picture, float(self._warp[0, 2]), float(self._warp[1, 2]), radius)


def _is_good(fit: Fit) -> bool:
    return fit.score >= _GOOD_SCORE and fit.support >= _LEAST_SUPPORT


def _is_possible(fit: Fit) -> bool:
    return fit.score >= _LEAST_SCORE and fit.support >= _LEAST_SUPPORT


def _is_within(band: Band | None, fit: Fit) -> bool:
    return band is None or band.holds(float(fit.warp[0, 2]), float(fit.warp[1, 2]), scale_of(fit.warp))


def _with_band(fit: Fit, band: Band | None) -> Fit:
    expected = band.expected() if band is not None else None
    return fit if expected is None else fit.fused_with(*expected)


def _vagueness(sigma: float, warp: Warp) -> str:
    return (
        f"its place is known to {sigma:.0f} px only"
        if sigma > _UNSURE_SIGMA * max(1.0, scale_of(warp))
        else ""
    )
