"""The way to a stand before a thing: straight if that is free, else round what is in the way, or refused.

As few legs as will do: turn and advance; the same after backing off over floor that is known to be free; over
one place beside the things in the way; over two.
"""

import math
from collections.abc import Sequence

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.approach import NEAR_SHARE, Approach, Leg, NoWay
from tapreach.tasks.fetch.body import Body, covariance_of_way
from tapreach.tasks.fetch.detour_search import quickest_detour
from tapreach.tasks.fetch.final_leg import ANY_SIDE, Blocked, FinalLeg, Goal, Sides
from tapreach.tasks.fetch.obstacle import Obstacle, into
from tapreach.tasks.fetch.passage import Passage
from tapreach.tasks.fetch.refusal import GOAL_NAME, named, refusal, stuck
from tapreach.tasks.fetch.route import HERE, Route, legs_of
from tapreach.tasks.fetch.thing import ThingSize

_BACK_STEP, _LONGEST_BACK = 0.05, 0.6


def plan_approach(
    size: ThingSize,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    body: Body,
    free_behind: float = 0.0,
    sides: Sides = ANY_SIDE,
) -> Approach | NoWay:
    """Return the way from `world_from_base` to a stand before the thing, clear of `others` (in the world).

    free_behind: how far straight back the floor is known to be free [m]. sides: from where it is to be
    gripped. What may stand in the same place as the thing is the thing itself.
    """
    middle = into(world_from_base, np.asarray(size.axis_in_world, dtype=np.float64)[None, :2])[0]
    here = Obstacle(GOAL_NAME, middle, middle, size.width / 2.0, 0.0)
    seen = [other.seen_from(world_from_base) for other in others]
    passage = Passage.among([each for each in seen if not is_same(each, here)], here, body)
    if (touched := passage.touching) is not None:
        return stuck(touched)
    size = size.seen_from(world_from_base)
    goal = Goal(size, middle, body, passage, world_from_base.heading, sides)
    found = _planned(goal, free_behind)
    return found if isinstance(found, NoWay) else found.seen_from_world(world_from_base)


def is_same(other: Obstacle, goal: Obstacle) -> bool:
    """Tell whether `other` is what is to be fetched, located another time: its middle may lie within it."""
    return other.may_be_at(goal.centre, goal.radius)


def _planned(goal: Goal, free_behind: float) -> Approach | NoWay:
    direct = goal.final_legs(HERE)
    if not direct:
        return NoWay("the claw does not get around it", "")
    straight: list[Route] = [((), leg) for leg in direct if isinstance(leg, FinalLeg)]
    if any(leg.is_whole for _, leg in straight):
        return _approach(_cheapest(straight), goal, "")
    if straight or any(isinstance(each, Blocked) and each.of == "near" for each in direct):
        straight += _after_backing_off(goal, free_behind)
    if straight:
        return _approach(_cheapest(straight), goal, "")
    blocked = next(each for each in direct if isinstance(each, Blocked))
    around = quickest_detour(goal)
    if around is None:
        return refusal(blocked, goal)
    return _approach(around, goal, "" if blocked.by is None else named(blocked.by))


def _after_backing_off(goal: Goal, free_behind: float) -> list[Route]:
    found: list[Route] = []
    for i in range(1, 1 + int(min(free_behind, _LONGEST_BACK) / _BACK_STEP + 1e-9)):
        back = PlanarStep(0.0, -i * _BACK_STEP)
        if goal.passage.in_the_way_of_advance(HERE, back.advance) is not None:
            break
        found += [((back,), leg) for leg in goal.final_legs(HERE.after(back)) if isinstance(leg, FinalLeg)]
    return found


def _cheapest(routes: Sequence[Route]) -> Route:
    return min(routes, key=lambda route: route[1].cost + 3.0 * len(route[0]))


def _approach(route: Route, goal: Goal, round_what: str) -> Approach:
    final, body = route[1], goal.body
    legs = [leg for leg in legs_of(route, goal) if leg.step != PlanarStep(0.0, 0.0)]
    last = Leg(PlanarStep(0.0, final.stretch), NEAR_SHARE, goal.sees((final.last_look, final.stand)))
    return Approach(
        start=HERE,
        legs=tuple(legs),
        is_whole_at_last_look=final.is_whole,
        last_stretch=last,
        stance=final.stance,
        seen_at_stand=goal.seen_from(final.stand),
        side=final.side,
        blind_cov=_blind_covariance(final, body),
        round_what=round_what,
        seconds=sum(leg.seconds(body.base) for leg in (*legs, last)),
    )


def _blind_covariance(final: FinalLeg, body: Body) -> FloatArray:
    """Return (2, 2), along and across the claw: how far off the thing is in the base by the last stretch."""
    pose_cov = covariance_of_way(body.noise, final.last_look, final.stand)
    x, y = final.stance.thing_in_base
    by_pose = np.array([[-1.0, 0.0, y], [0.0, -1.0, -x]])
    c, s = math.cos(final.stance.rotation), math.sin(final.stance.rotation)
    in_claw = np.array([[c, s], [-s, c]]) @ by_pose
    return np.asarray(in_claw @ pose_cov @ in_claw.T)
