"""Before anything moves: can this be fetched, if not why and what would help, and how it would be done.

A pure function of the thing, the other known things, the robot's pose and its file.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from tapreach.geometry.finite import finite_array
from tapreach.geometry.gaussian import require_covariance
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.approach import Approach, NoWay
from tapreach.tasks.fetch.approach_plan import plan_approach
from tapreach.tasks.fetch.believed_size import (
    believed,
    looks_over_its_corner,
    may_be_over_its_corner,
    supposed_size,
)
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.final_leg import Sides
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.reach import Judgement, Verdict, judge
from tapreach.tasks.fetch.reach_preview import ReachPreview, grasp_in_world
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tapreach.tasks.fetch.too_high import refused_by_place

OTHER_SIDES = 2
"""So often another side of what is too wide is looked for."""
_PLACE_SHARE = 0.25
"""A place known worse than this share of its distance (two sigmas) is not driven up to as it is."""
_SURE = 2.0


def preview(
    thing: Thing,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    description: RobotDescription,
    *,
    free_behind: float = 0.0,
    is_last_look: bool = False,
    other_sides: int = 0,
    missed_from: Sequence[float] = (),
    kept: float | None = None,
    drifts: bool = True,
) -> ReachPreview:
    """Return whether and how the robot, standing at `world_from_base`, can fetch the thing.

    others: what must not be touched, in the world. free_behind: how far straight back the floor is known to
    be free [m]. is_last_look: the thing will not be measured better: widths count as they are, and what
    cannot be told then is a no. other_sides: how often another side was sought, as it was too wide from near.
    missed_from: directions in the world [rad] from which the claw closed in vain: what may have been a box
    over its corner is gripped from another one, where a way leads there. kept: servo A as planned before
    [rad]. drifts: the way keeps clear of the others by what odometry may be off there, too. Raises InputError
    for values that are not finite, and for what is no covariance.
    """
    finite_array("point_in_world", thing.point_in_world, (3,))
    require_covariance("point_cov_in_world", thing.point_cov_in_world, 3)
    body = Body.of(description) if drifts else Body.of(description).without_drift()
    seeks = other_sides <= OTHER_SIDES
    sides = Sides(tuple(missed_from), kept)
    asked = _Asked(thing, others, world_from_base, body, free_behind, is_last_look, seeks, sides)
    is_near = is_last_look or other_sides > 0
    size = thing.size if is_near else believed(thing.size, world_from_base, body)
    if isinstance(size, ThingSize):
        found = asked.measured(size)
    else:
        found = asked.unmeasured(size)
        # From far another side is hardly a way round, and the thing stays in the picture.
        if isinstance(thing.size, ThingSize) and looks_over_its_corner(thing.size, body):
            aside = asked.measured(thing.size)
            found = aside if aside.from_another_side else found
    if is_last_look and found.verdict is Verdict.UNSURE and not found.from_another_side:
        return replace(found, verdict=Verdict.NO)
    return found


@dataclass(frozen=True)
class _Asked:
    """What `preview` was asked. seeks: whether another side of what is too wide is still sought."""

    thing: Thing
    others: Sequence[Obstacle]
    world_from_base: PlanarPose
    body: Body
    free_behind: float
    is_last_look: bool
    seeks: bool
    sides: Sides

    def unmeasured(self, why: NoSize) -> ReachPreview:
        """Plan for a usual size, as it is not known."""
        size = supposed_size(self.thing, self.world_from_base)
        judged = self._too_high() or judge(size, self.body.claw)
        if judged.verdict is Verdict.NO:
            return ReachPreview(Verdict.NO, judged.reason, judged.advice, size, True)
        way = self._way(size)
        if isinstance(way, NoWay):
            return ReachPreview(Verdict.NO, way.reason, way.advice, size, True)
        reason, nearer = f"its size is not known: {why.reason}", "drive nearer, or draw a box around it"
        return ReachPreview(Verdict.UNSURE, reason, nearer, size, True, approach=way)

    def measured(self, size: ThingSize) -> ReachPreview:
        """Plan for a size that is believed; where no way leads to another side, from where it is."""
        finite_array("axis_in_world", size.axis_in_world, (3,))
        require_covariance("axis_cov_in_world", size.axis_cov_in_world, 3)
        size = size.seen_from(self.world_from_base).across(size.sight_from(self.world_from_base))
        judged = judge(size, self.body.claw, self.is_last_look, self.seeks)
        found = self._judged(size, judged)
        if found.approach is not None or not judged.from_another_side:
            return found
        here = judge(size, self.body.claw, self.is_last_look, seeks_another_side=False)
        as_it_is = self._judged(size, here)
        return found if as_it_is.approach is None else as_it_is

    def _judged(self, size: ThingSize, judged: Judgement) -> ReachPreview:
        if judged.verdict is not Verdict.YES or size.by_picture:
            judged = self._too_high() or judged
        if judged.grip is None and not judged.from_another_side:
            return ReachPreview(judged.verdict, judged.reason, judged.advice, size)
        seeks = judged.from_another_side
        way = self._way(size, _better_fit(size, self.body) if seeks else 0.0)
        if isinstance(way, NoWay):
            return _without_way(way, judged, size)
        judged = _from_side(judged, size, way, self.body, self.is_last_look)
        judged = _placed(judged, size, self.world_from_base)
        reason = f"{way.in_words()}. {judged.reason}"
        grasp = grasp_in_world(way, self.body)
        return ReachPreview(judged.verdict, reason, judged.advice, size, False, seeks, way, grasp)

    def _way(self, size: ThingSize, least_fit: float = 0.0) -> Approach | NoWay:
        plan = partial(plan_approach, size, self.others, self.world_from_base, self.body, self.free_behind)
        if self.sides.missed_from and may_be_over_its_corner(size, self.body):
            way = plan(replace(self.sides, least_fit=least_fit))
            if isinstance(way, Approach):
                return way
        return plan(Sides(kept=self.sides.kept, least_fit=least_fit))

    def _too_high(self) -> Judgement | None:
        """Return the refusal of what was tapped too high up: where nobody drew it, the outline of what stands
        on something is often that of both.
        """
        return refused_by_place(self.thing.point_in_world, self.thing.point_cov_in_world, self.body.claw)


def _without_way(way: NoWay, judged: Judgement, size: ThingSize) -> ReachPreview:
    if judged.from_another_side:
        return ReachPreview(Verdict.NO, f"{judged.reason}, and {way.reason}", way.advice, size)
    return ReachPreview(Verdict.NO, way.reason, way.advice, size)


def _better_fit(size: ThingSize, body: Body) -> float:
    """Return the probability of a fit that another side must promise: halfway from here to the best."""
    opens = body.claw.opens_to
    return 0.5 * (size.fits(opens) + size.footprint.best_fit(opens))


def _from_side(
    judged: Judgement, size: ThingSize, way: Approach, body: Body, is_last_look: bool
) -> Judgement:
    """Judge the width as the claw will find it, from where it comes."""
    if judged.verdict is not Verdict.YES and not (is_last_look and judged.from_another_side):
        return judged
    found = size.across(way.stand.heading + way.stance.rotation)
    again = judge(found, body.claw, is_last_look, seeks_another_side=False)
    if is_last_look and judged.from_another_side:
        return again if again.verdict is Verdict.YES else judged
    if is_last_look or again.verdict is Verdict.YES:
        return judged
    words = f"{judged.reason}; from the side where it is gripped its width is not known"
    return replace(judged, verdict=Verdict.UNSURE, reason=words, advice="look at it from there")


def _placed(judged: Judgement, size: ThingSize, world_from_base: PlanarPose) -> Judgement:
    """Doubt what is known too badly to drive up to it."""
    off = np.asarray(size.axis_in_world)[:2] - [world_from_base.x, world_from_base.y]
    cov = np.asarray(size.axis_cov_in_world)[:2, :2]
    sd, distance = math.sqrt(max(float(np.linalg.eigvalsh(cov)[-1]), 0.0)), float(np.hypot(*off))
    if judged.verdict is not Verdict.YES or _SURE * sd <= _PLACE_SHARE * distance:
        return judged
    words = f"its place is known to ±{100.0 * _SURE * sd:.0f} cm only"
    return replace(judged, verdict=Verdict.UNSURE, reason=words, advice="locate it from farther apart views")
