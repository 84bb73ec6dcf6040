"""Sizes measured one after the other: what is believed of them, and what earlier ones add to a new one."""

import math
from dataclasses import dataclass, replace

from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.tasks.fetch.thing import SAME_SIDE, NoSize, ThingSize
from tapreach.tasks.sighting import is_apart

_SAME_SIGMAS = 3.0
_SAYS_LESS = 2.0
"""A width known so many times worse than the one before, one sigma, changes nothing."""
_ELSEWHERE = 0.05, math.radians(5.0)
"""A size measured again after so much of a way [m], [rad] rests on other pictures."""


@dataclass
class SizeDoubt:
    """What was measured and not believed yet, each with where the base stood: a size `against` the one that
    is known, and one told by a single view, `alone`. Both are believed once another from elsewhere agrees.
    taken_from: where the base stood when the known one was measured, None where that is not known. denied:
    how often no side of it was found since, each time from elsewhere; denied_from: from where last.
    """

    against: tuple[ThingSize, PlanarPose] | None = None
    alone: tuple[ThingSize, PlanarPose] | None = None
    taken_from: PlanarPose | None = None
    denied: int = 0
    denied_from: PlanarPose | None = None

    def believed(
        self, new: ThingSize | NoSize, current: ThingSize | NoSize, here: PlanarPose, seen_along: float
    ) -> ThingSize | None:
        """Return the size that a new measurement makes known; None where it changes nothing.

        seen_along: the new line of sight's direction in the world [rad].
        """
        if isinstance(new, ThingSize) and isinstance(current, ThingSize):
            new = new.at_least_as_high_as(current)
        if isinstance(new, NoSize):
            believed = self._confirmed(new.by_one_view, here) or self._told_twice(new.by_one_view, here)
        elif isinstance(current, NoSize) or not contradicts(new, current, seen_along):
            self.against = None
            is_known_better = isinstance(current, ThingSize) and _says_less(new, current, seen_along)
            believed = None if is_known_better else replace(new, told=self._times_told(new, current, here))
        else:
            before, self.against = _newest(self.against, new, here)
            is_told = before is not None and not contradicts(new, before, seen_along)
            believed = replace(new, told=2) if is_told else None
        if believed is not None and (isinstance(current, NoSize) or believed.told != current.told):
            self.taken_from = here
        self._count_denials(new, believed is not None, here)
        return believed

    def _count_denials(self, new: ThingSize | NoSize, is_told: bool, here: PlanarPose) -> None:
        if is_told:
            self.denied, self.denied_from = 0, None
        elif isinstance(new, NoSize) and new.denies_sides and self._is_elsewhere(here):
            self.denied, self.denied_from = self.denied + 1, here

    def _is_elsewhere(self, here: PlanarPose) -> bool:
        return self.denied_from is None or is_apart(self.denied_from, here, *_ELSEWHERE)

    def _confirmed(self, alone: ThingSize | None, here: PlanarPose) -> ThingSize | None:
        """Return what was measured against the known size, where one view from elsewhere tells the same."""
        if self.against is None or alone is None:
            return None
        against, there = self.against
        if not is_apart(there, here, *_ELSEWHERE) or not agree(alone, against):
            return None
        self.against = None
        return replace(against, told=2)

    def _told_twice(self, new: ThingSize | None, here: PlanarPose) -> ThingSize | None:
        if new is None:
            return None
        before, self.alone = _newest(self.alone, new, here)
        return replace(new, told=2) if before is not None and agree(new, before) else None

    def _times_told(self, new: ThingSize, current: ThingSize | NoSize, here: PlanarPose) -> int:
        if isinstance(current, NoSize) or not agree(new, current):
            return 1
        is_elsewhere = self.taken_from is not None and is_apart(self.taken_from, here, *_ELSEWHERE)
        return current.told + int(is_elsewhere)


def _says_less(new: ThingSize, current: ThingSize, seen_along: float) -> bool:
    """Tell whether a new width of the same side agrees only because it says so little itself."""
    return _is_same_side(current, seen_along) and new.width_sd > _SAYS_LESS * current.width_sd


def _newest(
    before: tuple[ThingSize, PlanarPose] | None, new: ThingSize, here: PlanarPose
) -> tuple[ThingSize | None, tuple[ThingSize, PlanarPose]]:
    """Return what was measured before from elsewhere, and what is to be kept."""
    if before is not None and not is_apart(before[1], here, *_ELSEWHERE):
        return None, before
    return (None if before is None else before[0]), (new, here)


def with_earlier(new: ThingSize, earlier: ThingSize | None, seen_along: float) -> ThingSize:
    """Return the new size, made surer by an earlier one as far as both can be of the same side of it.

    seen_along: the new line of sight's direction in the world [rad]. The errors of both are taken to be the
    same error, as they come of one method: the mean is no surer than the better of the two.
    """
    if earlier is None or earlier.seen_along is None or not agree(new, earlier):
        return new
    height, height_sd = _mean(new.height, new.height_sd, earlier.height, earlier.height_sd)
    if abs(wrapped(seen_along - earlier.seen_along)) > SAME_SIDE:
        return replace(new, height=height, height_sd=height_sd)
    width, width_sd = _mean(new.width, new.width_sd, earlier.width, earlier.width_sd)
    return replace(new, width=width, width_sd=width_sd, height=height, height_sd=height_sd)


def contradicts(new: ThingSize, current: ThingSize, seen_along: float) -> bool:
    """Tell whether a new size differs by more than chance from the current one, of the same side.

    seen_along: as above. What stands close behind or beside the thing now and then passes for part of it.
    """
    return _is_same_side(current, seen_along) and not agree(new, current)


def _is_same_side(current: ThingSize, seen_along: float) -> bool:
    return current.seen_along is None or abs(wrapped(seen_along - current.seen_along)) <= SAME_SIDE


def agree(new: ThingSize, earlier: ThingSize) -> bool:
    """Tell whether two sizes may be of one thing seen from one side."""
    by_width = abs(new.width - earlier.width) / math.hypot(new.width_sd, earlier.width_sd)
    by_height = abs(new.height - earlier.height) / math.hypot(new.height_sd, earlier.height_sd)
    return max(by_width, by_height) <= _SAME_SIGMAS and new.foot == earlier.foot


def _mean(a: float, a_sd: float, b: float, b_sd: float) -> tuple[float, float]:
    """Return the weighted mean of two values, and its sigma where their errors are one and the same."""
    share = b_sd**2 / (a_sd**2 + b_sd**2)
    return share * a + (1.0 - share) * b, share * a_sd + (1.0 - share) * b_sd
