"""Before anything moves: can this be fetched, if not why and what would help, and how it would be done.

A pure function of the thing, the other known things, the robot's pose and its file.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from tapreach.geometry.finite import FloatArray, finite_array
from tapreach.geometry.gaussian import require_covariance
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.approach import Approach, NoWay
from tapreach.tasks.fetch.approach_plan import plan_approach
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import Obstacle, out_of
from tapreach.tasks.fetch.reach import OFF_FLOOR, Judgement, Verdict, is_narrower_elsewhere, judge
from tapreach.tasks.fetch.thing import NoSize, Thing, ThingSize
from tapreach.tasks.fetch.too_high import refused_by_place

SUPPOSED_WIDTH, SUPPOSED_HEIGHT = 0.06, 0.10
"""What is approached to be measured is supposed to be so large [m]."""
_SUPPOSED_SD = 0.4
"""One sigma of both, as a share."""
OTHER_SIDES = 2
"""So often another side of what is too wide is looked for."""
WIDTH_TOLD_WITHIN = 0.9
WIDTH_TOLD = 2
"""What is too wide by its outline in pictures from farther away [m], or by fewer looks, is first looked at
from near.
"""
_PLACE_SHARE = 0.25
"""A place known worse than this share of its distance (two sigmas) is not driven up to as it is."""
_SURE = 2.0


@dataclass(frozen=True)
class Grasp:
    """What is to be drawn of the grasp, in the world [m].

    tip_before, tip (3,): the gripping point before the arm goes out, and when it grips. fingers: inner edge
    of the left and the right finger (2, 3) each, wrist side first, while the claw is open. opening [m].
    """

    tip_before: FloatArray
    tip: FloatArray
    fingers: tuple[FloatArray, FloatArray]
    opening: float


@dataclass(frozen=True)
class ReachPreview:
    """Whether the thing can be fetched, why, and what would help ('' for nothing).

    UNSURE with an approach: driving it shows; the verdict at its last look counts. approach and grasp are
    None where there is nothing to show. size: what was planned for, supposed where `is_supposed`.
    from_another_side: the way leads to where it may be narrower; that is UNSURE also at the last look.
    """

    verdict: Verdict
    reason: str
    advice: str
    size: ThingSize | None = None
    is_supposed: bool = False
    from_another_side: bool = False
    approach: Approach | None = None
    grasp: Grasp | None = None

    @property
    def path(self) -> tuple[PlanarPose, ...]:
        """Base poses world_from_base from the start to the stand; none without a way."""
        return () if self.approach is None else self.approach.path

    @property
    def driving_seconds(self) -> float:
        """Expected time of driving [s]; 0 without a way."""
        return 0.0 if self.approach is None else self.approach.seconds


def preview(
    thing: Thing,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    description: RobotDescription,
    *,
    free_behind: float = 0.0,
    is_last_look: bool = False,
    other_sides: int = 0,
    drifts: bool = True,
) -> ReachPreview:
    """Return whether and how the robot, standing at `world_from_base`, can fetch the thing.

    others: what must not be touched, in the world. free_behind: how far straight back the floor is known to
    be free [m]. is_last_look: the thing will not be measured better: widths count as they are, and what
    cannot be told then is a no. other_sides: how often another side was sought, as it was too wide from near.
    drifts: the way keeps clear of the others by what odometry may be off there, too. Raises InputError for
    values that are not finite, and for what is no covariance.
    """
    finite_array("point_in_world", thing.point_in_world, (3,))
    require_covariance("point_cov_in_world", thing.point_cov_in_world, 3)
    body = Body.of(description) if drifts else Body.of(description).without_drift()
    is_near = is_last_look or other_sides > 0
    size = thing.size if is_near else _believed(thing.size, world_from_base, body)
    seeks = other_sides <= OTHER_SIDES
    plan = partial(_measured, thing, others, world_from_base, body, free_behind, is_last_look, seeks)
    if isinstance(size, ThingSize):
        found = plan(size)
    else:
        found = _unmeasured(thing, size, others, world_from_base, body, free_behind)
        # From far another side is hardly a way round, and the thing stays in the picture.
        if isinstance(thing.size, ThingSize) and _looks_over_its_corner(thing.size, body):
            aside = plan(thing.size)
            found = aside if aside.from_another_side else found
    if is_last_look and found.verdict is Verdict.UNSURE and not found.from_another_side:
        return replace(found, verdict=Verdict.NO)
    return found


def _looks_over_its_corner(size: ThingSize, body: Body) -> bool:
    is_told = size.told >= WIDTH_TOLD and not size.goes_on_above
    return is_told and is_narrower_elsewhere(size, body.claw)


def _believed(size: ThingSize | NoSize, world_from_base: PlanarPose, body: Body) -> ThingSize | NoSize:
    """Return the size, or why it is not believed: from far, or by one look alone, what stands close to the
    thing may pass for part of it.
    """
    if isinstance(size, NoSize) or not size.by_picture:
        return size
    is_too_wide = size.width > body.claw.opens_to
    stands_on = size.goes_on_above and size.foot <= OFF_FLOOR
    if not is_too_wide and not stands_on:
        return size
    off = np.asarray(size.axis_in_world)[:2] - [world_from_base.x, world_from_base.y]
    is_near = float(np.hypot(*off)) <= WIDTH_TOLD_WITHIN
    if is_too_wide and is_near and size.told >= WIDTH_TOLD:
        return size
    looks = f"{1000.0 * size.width:.0f} mm wide and {1000.0 * size.height:.0f} mm high"
    return NoSize(f"it looks {looks} from here; what stands close to it may pass for part of it")


def supposed_size(thing: Thing, world_from_base: PlanarPose) -> ThingSize:
    """Return what a thing of unknown size is taken for until it is measured: standing on the floor."""
    point = np.asarray(thing.point_in_world, dtype=np.float64)
    off = point[:2] - [world_from_base.x, world_from_base.y]
    behind = SUPPOSED_WIDTH / 2.0 * off / max(float(np.hypot(*off)), 1e-9)
    height = max(SUPPOSED_HEIGHT, 1.2 * float(point[2]))
    axis = np.array([*(point[:2] + behind), height / 2.0])
    width_sd, height_sd = _SUPPOSED_SD * SUPPOSED_WIDTH, _SUPPOSED_SD * height
    cov = np.asarray(thing.point_cov_in_world, dtype=np.float64)
    return ThingSize(SUPPOSED_WIDTH, width_sd, height, height_sd, 0.0, axis, cov, "its size is supposed")


def _unmeasured(
    thing: Thing,
    why: NoSize,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    body: Body,
    free_behind: float,
) -> ReachPreview:
    size = supposed_size(thing, world_from_base)
    judged = _too_high(thing, body) or judge(size, body.claw)
    if judged.verdict is Verdict.NO:
        return ReachPreview(Verdict.NO, judged.reason, judged.advice, size, True)
    way = plan_approach(size, others, world_from_base, body, free_behind)
    if isinstance(way, NoWay):
        return ReachPreview(Verdict.NO, way.reason, way.advice, size, True)
    reason, nearer = f"its size is not known: {why.reason}", "drive nearer, or draw a box around it"
    return ReachPreview(Verdict.UNSURE, reason, nearer, size, True, approach=way)


def _measured(
    thing: Thing,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    body: Body,
    free_behind: float,
    is_last_look: bool,
    seeks: bool,
    size: ThingSize,
) -> ReachPreview:
    """Plan for a size that is believed; where no way leads to another side, from where it is."""
    finite_array("axis_in_world", size.axis_in_world, (3,))
    require_covariance("axis_cov_in_world", size.axis_cov_in_world, 3)
    size = size.seen_from(world_from_base).across(size.sight_from(world_from_base))
    judged = judge(size, body.claw, is_last_look, seeks)
    plan = partial(_judged, thing, size, others, world_from_base, body, free_behind, is_last_look)
    found = plan(judged)
    if found.approach is None and judged.from_another_side:
        as_it_is = plan(judge(size, body.claw, is_last_look, seeks_another_side=False))
        return found if as_it_is.approach is None else as_it_is
    return found


def _judged(
    thing: Thing,
    size: ThingSize,
    others: Sequence[Obstacle],
    world_from_base: PlanarPose,
    body: Body,
    free_behind: float,
    is_last_look: bool,
    judged: Judgement,
) -> ReachPreview:
    if judged.verdict is not Verdict.YES or size.by_picture:
        judged = _too_high(thing, body) or judged
    if judged.grip is None and not judged.from_another_side:
        return ReachPreview(judged.verdict, judged.reason, judged.advice, size)
    seeks = judged.from_another_side
    least_fit = _better_fit(size, body) if seeks else 0.0
    way = plan_approach(size, others, world_from_base, body, free_behind, least_fit)
    if isinstance(way, NoWay):
        return _without_way(way, judged, size)
    judged = _from_side(judged, size, way, body, is_last_look)
    judged = _placed(judged, size, world_from_base)
    reason = f"{way.in_words()}. {judged.reason}"
    grasp = grasp_in_world(way, body)
    return ReachPreview(judged.verdict, reason, judged.advice, size, False, seeks, way, grasp)


def _too_high(thing: Thing, body: Body) -> Judgement | None:
    """Return the refusal of what was tapped too high up: where nobody drew it, the outline of what stands on
    something is often that of both.
    """
    return refused_by_place(thing.point_in_world, thing.point_cov_in_world, body.claw)


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


def grasp_in_world(way: Approach, body: Body) -> Grasp:
    """Return what is to be drawn of the grasp at the end of the way."""
    before, tip = way.stance.tips(body.claw)
    c, s = math.cos(way.stance.rotation), math.sin(way.stance.rotation)
    ahead, left = np.array([c, s, 0.0]), np.array([-s, c, 0.0])
    beyond, half = body.claw.beyond, way.stance.grip.opening / 2.0
    ends = np.array([tip - beyond * ahead, tip + beyond * ahead])
    fingers = ends + half * left, ends - half * left
    opening = way.stance.grip.opening
    left_finger, right_finger = (_in_world(way.stand, finger) for finger in fingers)
    before, tip = (_in_world(way.stand, point[None])[0] for point in (before, tip))
    return Grasp(before, tip, (left_finger, right_finger), opening)


def _in_world(stand: PlanarPose, points_in_base: FloatArray) -> FloatArray:
    return np.column_stack([out_of(stand, points_in_base[:, :2]), points_in_base[:, 2]])
