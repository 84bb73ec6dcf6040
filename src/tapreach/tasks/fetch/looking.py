"""The first phases of a fetch: where the thing is and how large, and whether it can be fetched."""

import math
from functools import partial

import numpy as np

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.tasks.aiming import aimed
from tapreach.tasks.camera_delay import know_delay
from tapreach.tasks.fetch.as_tapped import remember_tapped
from tapreach.tasks.fetch.by_colours import learn_colours
from tapreach.tasks.fetch.fetch_state import FetchPlan, Mode
from tapreach.tasks.fetch.looking_again import (
    is_where_it_was,
    keep_what_is_known,
    locate_again,
    still_followed,
    tap_again,
    tap_unseen,
)
from tapreach.tasks.fetch.preview import preview
from tapreach.tasks.fetch.reach import Verdict
from tapreach.tasks.fetch.reach_preview import ReachPreview
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.size import size_of
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.stepping_back import found_from_farther
from tapreach.tasks.fetch.surroundings import to_plan_round
from tapreach.tasks.fetch.thing import NoSize
from tapreach.tasks.fetch.too_high import (
    refused_by_place,
    refused_by_sight,
    refused_unlocated,
    tap_within_reach_up_to,
)
from tapreach.tasks.fetch.unseen import refused_unseen
from tapreach.tasks.follower import Follower, TargetLost
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.locate_watch import HARDLY_KNOWN
from tapreach.tasks.locating import Locating
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap

ACCURACY = 0.02
"""Relative error of the range, one sigma, at which driving up begins: it is estimated on on the way."""
MOST_LOOKS = 5
GRASPING_SECONDS = 20.0
"""What looking at the claw, reaching, gripping and lifting take."""


async def look(run: FetchRun) -> Ended:
    """Locate the thing and measure it, unless it is too high by its line of sight alone; what was lost before
    much was known of its place, or could not be located, is looked at once more: the latter from where it is
    followed now, as the same pictures would tell the same. Raises as LocateTask.run.
    """
    ended = await _look_once(run)
    could_not = ended.outcome is Outcome.UNSURE and _is_seen(run)
    is_worth_more = could_not or (ended.outcome is Outcome.DONE and await _was_lost_early(run))
    if run.memory.looks >= MOST_LOOKS or not is_worth_more:
        return ended
    tap = still_followed(run) if could_not and run.memory.tap.box is None else None
    run.remember(looks=run.memory.looks + 1, tap=tap or run.memory.tap)
    return await _look_once(run)


def _is_seen(run: FetchRun) -> bool:
    return run.locating is not None and not run.locating.follower.loss


async def _was_lost_early(run: FetchRun) -> bool:
    """Tell whether it was lost before much was known of its place, and is seen again."""
    locating = run.locating
    if locating is None or locating.estimate is None or not locating.follower.loss or _is_too_high(run):
        return False
    return locating.estimate.relative_sd > HARDLY_KNOWN and await tap_again(run) is not None


def _is_too_high(run: FetchRun) -> bool:
    """Tell whether a spot tapped, of however little known a place, is surely too high."""
    thing = run.thing()
    refused = refused_by_place(thing.point_in_world, thing.point_cov_in_world, run.filed_claw)
    return run.memory.tap.box is None and refused is not None


async def _look_once(run: FetchRun) -> Ended:
    is_operators = run.memory.known is None
    tap = await _tap(run)
    if tap is None:
        return Ended(
            Outcome.LOST, "it is not seen where it should be: drive so that it is in the picture, and tap it"
        )
    context, target_id = run.context, run.memory.target_id
    run.recall_size()
    await end_following(run)
    tap = await aimed(context, tap)
    within = await _within_reach_up_to(run, tap)
    if high := refused_by_sight(within):
        return Ended(Outcome.CANNOT, high)
    await know_delay(context)
    report = TargetReport(target_id, TargetSource.LOCATE, tap, context.description)
    follower = Follower(context, tap, key=target_id, uses_background=run.ways.use_background)
    run.locating = Locating(context, follower, report, ACCURACY, run.ways.fixed_move)
    run.locating.keep_clear = (*run.others, *run.around.in_world())
    try:
        sentence = await locate_again(run, run.locating)
    except TargetLost as lost:
        return _not_located(Ended(Outcome.LOST, str(lost)), within, run.locating.estimate)
    estimate = run.locating.estimate
    if estimate is None or estimate.status is not Status.DETERMINED:
        return _not_located(Ended(Outcome.UNSURE, sentence), within, estimate)
    if not is_where_it_was(run):
        run.forget()
        await run.locating.recall(None)
    point = run.thing().point_in_world
    run.measured(run.locating.size or NoSize("it was not measured"), point)
    keep_what_is_known(run)
    if is_operators:
        await remember_tapped(run)
    await learn_colours(run)
    return Ended(Outcome.DONE, sentence)


async def _within_reach_up_to(run: FetchRun, tap: Tap) -> float:
    """Return up to which distance what is tapped may be low enough [m]; what the claw has been around is."""
    if run.memory.attempt > 1:
        return math.inf
    lowest = Pixel(tap.u, tap.v) if tap.box is None else tap.box.foot
    return await run.context.compute.call(tap_within_reach_up_to, lowest, run.context.description)


def _not_located(ended: Ended, within: float, estimate: PointEstimate | None) -> Ended:
    """Refuse what is too high unless it is near; else it ends as it ended."""
    interval = estimate.range_interval_95 if estimate is not None else None
    high = refused_unlocated(within, interval[0]) if interval else refused_unlocated(within)
    return Ended(Outcome.CANNOT, high) if high else ended


async def measure(run: FetchRun) -> None:
    """Measure the thing in the pictures that have been taken, and remember where it is. Pictures since it
    went out of sight say nothing new.
    """
    locating, tap = run.locating, run.memory.tap
    point = run.thing().point_in_world
    if locating is not None and locating.estimate is not None and not locating.follower.loss:
        is_drawn_in = locating.estimate.sightings[0].frame_id == tap.frame_id
        size = await size_of(run.context, locating.estimate, tap.box if is_drawn_in else None)
        run.measured(size, point)
    keep_what_is_known(run)
    await learn_colours(run)


async def judge_reach(run: FetchRun) -> Ended:
    """Say whether and how it can be fetched from here, and show the plan."""
    run.preview = seen = await previewed(run)
    if seen.verdict is Verdict.NO:
        return Ended(Outcome.CANNOT, in_words(seen))
    loss = run.locating.follower.loss if run.locating is not None else ""
    if doubtful := refused_unseen(run.thing(), run.filed_claw, loss):
        return Ended(Outcome.CANNOT, doubtful)
    if run.memory.mode is Mode.PLAN:
        return Ended(Outcome.PLAN_ONLY, in_words(seen))
    asks = run.memory.mode is Mode.CONFIRM and not run.memory.is_agreed
    return Ended(Outcome.ASK if asks else Outcome.DONE, in_words(seen))


async def previewed(run: FetchRun, is_last_look: bool = False) -> ReachPreview:
    """Return the preview from where the base is now, round what is told and what the pictures have shown, as
    far as a way leads there.
    """
    thing, estimate = run.thing(), run.locating.estimate if run.locating is not None else None
    plan = partial(
        preview,
        free_behind=way_behind(run.context.poses),
        is_last_look=is_last_look,
        other_sides=run.memory.other_sides,
        missed_from=run.memory.missed_from,
        kept=run.preview.approach.stance.rotation if run.preview and run.preview.approach else None,
    )
    if estimate is not None:
        await run.around.look(run.context, estimate, thing)
    seen = run.around.obstacles(run.here, thing, run.context.description)
    for clear_of in to_plan_round(run.others, seen):
        sought = partial(plan, drifts=clear_of.drifts)
        found = await run.context.compute.call(
            sought, thing, clear_of.obstacles, run.here, run.context.description
        )
        if found.approach is not None:
            break
    return found


def plan_of(seen: ReachPreview) -> FetchPlan:
    """Return a preview as the page shows it."""
    lines: tuple[FloatArray, ...] = ()
    if seen.grasp is not None:
        reach_out = np.array([seen.grasp.tip_before, seen.grasp.tip])
        lines = (*seen.grasp.fingers, reach_out)
    seconds = seen.driving_seconds + GRASPING_SECONDS if seen.approach is not None else None
    return FetchPlan(seen.verdict, seen.reason, seen.advice, seen.path, lines, seconds)


def in_words(seen: ReachPreview) -> str:
    """Return the reason, and what would help."""
    return "; ".join(filter(None, [seen.reason, seen.advice]))


async def end_following(run: FetchRun) -> None:
    """Forget the tracker of an earlier look."""
    if run.locating is not None:
        await run.locating.follower.close()
        run.locating = None


async def _tap(run: FetchRun) -> Tap | None:
    """Return the tap that began it; later one on the thing where it is seen by now, None where it is not."""
    memory = run.memory
    if memory.known is None:
        return memory.tap
    tap = still_followed(run) or await tap_again(run) or memory.seen_again or await tap_unseen(run)
    tap = tap or await found_from_farther(run)
    if tap is not None:
        run.remember(tap=tap, seen_again=None)
    return tap
