"""The quickest way round what is in the way: over one place, or else over two.

All ways are ranked by their time at steady speeds; the first of them that is free is taken.
"""

from collections.abc import Iterable

import numpy as np

from tapreach.control.relative_move import GENTLE, advance_profile, turn_profile
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.tasks.fetch.detour import Places, places_around
from tapreach.tasks.fetch.durations import slide_seconds
from tapreach.tasks.fetch.final_leg import NEVER_WHOLE_STRETCH, FinalLeg, Goal
from tapreach.tasks.fetch.route import HERE, Route

_LONGER_RING = 0.08, 0.3
_TWO_TURNS = 2.0 * np.pi


def quickest_detour(goal: Goal) -> Route | None:
    """Return the quickest way over one place, or else over two; None where there is none."""
    if not goal.stances:
        return None
    stance = goal.stances[0]
    ring = float(stance.thing_in_base[0]) + (stance.stretch or NEVER_WHOLE_STRETCH)
    rings = [ring + longer for longer in _LONGER_RING]
    search = _Detours(goal, places_around(goal.passage, goal.middle, rings, goal.body))
    return search.over_one() or search.over_two()


class _Detours:
    """Ways over places 0 to n − 1; what was found out about a place is kept."""

    def __init__(self, goal: Goal, places: Places) -> None:
        self._goal, self._places, self._joined = goal, places.places, places.joined
        self._is_free_to: dict[int, bool] = {}
        self._is_free_from: dict[int, bool] = {}
        base = goal.body.base
        self._speed, self._rate = GENTLE * base.max_linear, GENTLE * base.max_angular
        # What starting and landing take longer than steady driving.
        self._advance_more = slide_seconds(1.0, advance_profile(base)) - 1.0 / self._speed
        self._turn_more = slide_seconds(1.0, turn_profile(base)) - 1.0 / self._rate
        self._bearings = np.arctan2(self._places[:, 1], self._places[:, 0])
        self._headings, self._onward = self._final()

    def over_one(self) -> Route | None:
        """Return the quickest way over one place; None for none."""
        seconds = self._to_first() + self._turn(self._headings - self._bearings) + self._onward
        return self._first_free((int(i),) for i in np.argsort(seconds, kind="stable") if seconds[i] < np.inf)

    def over_two(self) -> Route | None:
        """Return the quickest way over two places; None for none."""
        ways = self._places[None] - self._places[:, None]
        bearings = np.arctan2(ways[..., 1], ways[..., 0])
        seconds = self._to_first()[:, None] + self._turn(bearings - self._bearings[:, None])
        seconds += np.hypot(ways[..., 0], ways[..., 1]) / self._speed + self._advance_more
        seconds += self._turn(self._headings[None] - bearings) + self._onward[None]
        seconds[~self._joined] = np.inf
        ranked = np.argsort(seconds, axis=None, kind="stable")
        pairs = (divmod(int(k), len(self._places)) for k in ranked if seconds.flat[k] < np.inf)
        return self._first_free(pairs)

    def _first_free(self, ranked: Iterable[tuple[int, ...]]) -> Route | None:
        for indices in ranked:
            if self._free_from(indices[-1]) and self._free_to(indices[0]):
                route = self._over(indices)
                if route is not None:
                    return route
        return None

    def _over(self, indices: tuple[int, ...]) -> Route | None:
        pose, steps = HERE, []
        for i in indices:
            steps.append(_step_to(pose, self._places[i]))
            pose = pose.after(steps[-1])
        last = self._goal.final_leg(pose, self._goal.stances[0])
        return (tuple(steps), last) if isinstance(last, FinalLeg) else None

    def _free_from(self, i: int) -> bool:
        """Tell whether the way from a place to the thing is free; there is room to turn at all places."""
        if i not in self._is_free_from:
            pose = PlanarPose(self._places[i, 0], self._places[i, 1], self._headings[i])
            last = self._goal.final_leg(pose, self._goal.stances[0])
            self._is_free_from[i] = isinstance(last, FinalLeg)
        return self._is_free_from[i]

    def _free_to(self, i: int) -> bool:
        """Tell whether the way from the start to a place is free."""
        if i not in self._is_free_to:
            step, passage = _step_to(HERE, self._places[i]), self._goal.passage
            turned = HERE.after(PlanarStep(step.turn, 0.0))
            self._is_free_to[i] = (
                passage.in_the_way_of_advance(turned, step.advance) is None
                and passage.in_the_way_of_turn(HERE, step.turn) is None
            )
        return self._is_free_to[i]

    def _final(self) -> tuple[FloatArray, FloatArray]:
        """Return the heading (n,) from each place to the thing, and the seconds (n,) on it with its side."""
        stance = self._goal.stances[0]
        headings, seconds = np.zeros(len(self._places)), np.full(len(self._places), np.inf)
        for i, place in enumerate(self._places):
            step = stance.approach_from(PlanarPose(place[0], place[1]), self._goal.middle)
            if step is not None and step.advance > 0.0:
                side = wrapped(step.turn + stance.rotation - self._goal.seen_along)
                headings[i] = step.turn
                seconds[i] = step.advance / self._speed + self._goal.side_seconds(side)
        return headings, seconds

    def _to_first(self) -> FloatArray:
        ways = np.hypot(*self._places.T)
        return np.asarray(self._turn(self._bearings) + ways / self._speed + self._advance_more)

    def _turn(self, angles: FloatArray) -> FloatArray:
        turns = np.abs(angles - _TWO_TURNS * np.rint(angles / _TWO_TURNS))
        return np.asarray(turns / self._rate + self._turn_more)


def _step_to(pose: PlanarPose, place: FloatArray) -> PlanarStep:
    off = place - np.array([pose.x, pose.y])
    return PlanarStep(
        wrapped(float(np.arctan2(off[1], off[0])) - pose.heading), float(np.hypot(off[0], off[1]))
    )
