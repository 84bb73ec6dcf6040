"""Driving up to the thing, leg by leg, each planned anew from what is known by then."""

import math
from contextlib import suppress

import numpy as np

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.fetch.approach import NEAR_SHARE, Approach, Leg
from tapreach.tasks.fetch.as_tapped import looks_as_tapped
from tapreach.tasks.fetch.blocked import back_off_from
from tapreach.tasks.fetch.followed_from_here import follow_from_here, has_grown
from tapreach.tasks.fetch.glance import glance
from tapreach.tasks.fetch.looking import ACCURACY, MOST_LOOKS, in_words, measure, previewed
from tapreach.tasks.fetch.looking_again import loss_of, still_followed, tap_again, tap_unseen
from tapreach.tasks.fetch.reach import Verdict
from tapreach.tasks.fetch.reach_preview import ReachPreview
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.stepping_back import BACK, LEAST_BACK, found_from_farther
from tapreach.tasks.fetch.thing import SAME_SIDE, NoSize, ThingSize
from tapreach.tasks.fetch.unseen import refused_unseen
from tapreach.tasks.follower import TargetLost
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.sighting import is_apart

MOST_LEGS = 24
"""Turns to look at the thing included: a way round several things needs more than a dozen."""
BLIND_SD = 0.006
"""A thing that is not seen any more is gripped where its place is known so well [m], one sigma."""
LOOK_ANEW_SD = 0.02
"""A thing in sight whose place is known worse [m], one sigma, is seen from a step back, or located anew."""
GONE_SD = 1.0
"""What is not seen and known no better [m], one sigma, is not driven after: it is nowhere in particular."""
LONGEST_LEG = 0.4
"""Farther than this the thing is not driven towards without planning anew [m]."""
_ELSEWHERE = 0.03, math.radians(5.0)
"""Views from farther apart than this [m, rad] tell more than one does."""
NEAR_ENOUGH, NEAR_ENOUGH_TURN = 0.03, math.radians(3.0)
"""A leg as short as this needs not be driven before the last look."""

OTHER_COLOURS = (
    "what stands there does not have the colours of the spot that was tapped: it is probably another thing; "
    "tap it again from nearer"
)


async def approach(run: FetchRun) -> Ended:
    """Drive to the last look. Raises MotionInterrupted, LinkLost."""
    unseen_way = 0.0
    for _ in range(MOST_LEGS):
        seen = run.preview = await previewed(run)
        if seen.verdict is Verdict.NO or seen.approach is None:
            return Ended(Outcome.CANNOT, in_words(seen))
        leg = next_leg(seen.approach)
        if leg is None:
            return Ended(Outcome.DONE, "near enough for the last look")
        back = None if leg.sees_thing or not run.ways.renews_on_way else glance(run, unseen_way)
        leg = leg if back is None else back
        if run.ways.renews_on_way and leg.sees_thing and has_grown(run):
            await follow_from_here(run, ACCURACY)
        try:
            blocked = await drive(run, leg)
        except TargetLost as lost:
            return await _anew(run, steps_back=True) or _lost(run, str(lost))
        if blocked and (ended := await back_off_from(run, blocked)):
            return ended
        await measure(run)
        unseen_way = unseen_way + abs(leg.step.advance) if loss_of(run) and back is None else 0.0
        is_gone = _is_lost(run, GONE_SD)
        if _is_lost(run, LOOK_ANEW_SD) and (anew := await _anew(run, steps_back=is_gone)):
            return anew
        if is_gone:
            return _lost(run, f"lost the thing on the way, {_known_to(run)}: {loss_of(run)}")
    return Ended(Outcome.CANNOT, await _not_arrived(run))


async def _not_arrived(run: FetchRun) -> str:
    """Return the true reason: too wide from every side that was seen, or too many legs."""
    size = run.thing().size
    if isinstance(size, ThingSize) and size.width > run.filed_claw.opens_to:
        return in_words(await previewed(run, is_last_look=True))
    return f"did not arrive before it in {MOST_LEGS} legs: the way keeps changing"


async def last_look(run: FetchRun) -> Ended:
    """Measure the thing from near and decide on the grasp."""
    if _is_lost(run, BLIND_SD):
        words = f"lost the thing, {_known_to(run)}: {loss_of(run)}"
        return await _anew(run, steps_back=True) or _lost(run, words)
    if _place_sd(run) > LOOK_ANEW_SD and (surer := await _made_surer(run)):
        return surer
    await measure(run)
    if is_to_be_measured(run):
        if anew := await _measured_anew(run):
            return anew
        run.believe_one_view()
    seen = run.preview = await previewed(run, is_last_look=True)
    if seen.verdict is Verdict.NO or seen.approach is None:
        return Ended(Outcome.CANNOT, in_words(seen))
    if next_leg(seen.approach) is not None:
        return _from_elsewhere(run, seen)
    if seen.verdict is Verdict.YES and not await looks_as_tapped(run):
        return Ended(Outcome.LOST, OTHER_COLOURS)
    return Ended(Outcome.DONE if seen.verdict is Verdict.YES else Outcome.CANNOT, in_words(seen))


def _lost(run: FetchRun, why: str) -> Ended:
    """Refuse what is lost and was doubtful, be it by one view; else it ends as lost."""
    run.believe_one_view()
    doubtful = refused_unseen(run.thing(), run.filed_claw, loss_of(run))
    return Ended(Outcome.CANNOT, doubtful) if doubtful else Ended(Outcome.LOST, why)


def _from_elsewhere(run: FetchRun, seen: ReachPreview) -> Ended:
    """End with driving on to another stand; what is too wide is believed to be so from now on."""
    assert seen.size is not None
    if seen.size.width > run.filed_claw.opens_to:
        run.remember(other_sides=run.memory.other_sides + 1)
    if seen.from_another_side:
        return Ended(Outcome.MISSED, in_words(seen))
    return Ended(Outcome.MISSED, "measured from near, it is to be gripped from elsewhere")


async def _anew(run: FetchRun, steps_back: bool = False) -> Ended | None:
    """End with locating the thing from here, if it is found in the picture, or else from a step farther back,
    and not too often before.
    """
    if not run.ways.renews_on_way or run.memory.looks >= MOST_LOOKS:
        return None
    known_to = _known_to(run)
    tap = still_followed(run) or await tap_again(run) or await tap_unseen(run)
    if tap is None and (not steps_back or await found_from_farther(run) is None):
        return None
    run.remember(looks=run.memory.looks + 1)
    return Ended(Outcome.UNSURE, f"{known_to}: located anew")


def is_to_be_measured(run: FetchRun) -> bool:
    """Tell whether nothing is known of its size, it was measured otherwise since, or nothing is known of its
    width across this sight: that of a box may be its diagonal from another side.
    """
    size = run.thing().size
    if isinstance(size, NoSize) or size.is_unconfirmed:
        return True
    along = size.sight_from(run.here)
    return size.aside_of_looks(along) > SAME_SIDE and size.across(along).width > run.filed_claw.opens_to


async def _measured_anew(run: FetchRun) -> Ended | None:
    """Back off from what could not be measured, and end with driving up again where that has shown how large
    it is, else with locating it from there; None where that was done, or where nothing is followed there.
    Where the floor behind is not known to be free it is located from where it stands.
    """
    if not run.ways.renews_on_way or run.memory.looks >= MOST_LOOKS:
        return None
    await _backed_off(run)
    if is_to_be_measured(run):
        return await _anew(run)
    run.remember(looks=run.memory.looks + 1)
    return Ended(Outcome.MISSED, "measured from farther back")


async def _made_surer(run: FetchRun) -> Ended | None:
    """End with driving up again to what is seen, but known too badly, after a step back with an eye on it;
    with locating it from here, where there is no room behind and its views are not all from here.
    """
    if not run.ways.renews_on_way or run.memory.looks >= MOST_LOOKS:
        return None
    known_to = _known_to(run)
    if await _backed_off(run):
        run.remember(looks=run.memory.looks + 1)
        return Ended(Outcome.MISSED, f"{known_to}: looked at from farther back")
    return await _anew(run) if _is_seen_from_elsewhere(run) else None


async def _backed_off(run: FetchRun) -> bool:
    """Step back over floor that is known to be free, following the thing, and measure it; False for no room
    to do so.
    """
    back = min(BACK, way_behind(run.context.poses))
    if back < LEAST_BACK:
        return False
    with suppress(TargetLost):
        await drive(run, Leg(PlanarStep(0.0, -back), NEAR_SHARE, sees_thing=True))
        await measure(run)
    return True


def _is_seen_from_elsewhere(run: FetchRun) -> bool:
    """Tell whether some of the views that its place rests on are not from here."""
    estimate = run.locating.estimate if run.locating is not None else None
    if estimate is None:
        return True
    return any(is_apart(view.world_from_base, run.here, *_ELSEWHERE) for view in estimate.sightings)


def _is_lost(run: FetchRun, sd: float) -> bool:
    """Tell whether the thing is not seen any more, and its place not known so well [m] either."""
    return bool(loss_of(run)) and _place_sd(run) > sd


def _known_to(run: FetchRun) -> str:
    return f"its place is known to ±{2000.0 * _place_sd(run):.0f} mm only"


def _place_sd(run: FetchRun) -> float:
    """Return one sigma of the tapped place [m], along the direction in which it is known worst."""
    return math.sqrt(max(0.0, float(np.linalg.eigvalsh(run.thing().point_cov_in_world)[-1])))


def next_leg(approach: Approach) -> Leg | None:
    """Return what is driven next, at most what is driven without planning anew; None at the last look."""
    for leg in approach.legs:
        if abs(leg.step.turn) > NEAR_ENOUGH_TURN or abs(leg.step.advance) > NEAR_ENOUGH:
            advance = math.copysign(min(abs(leg.step.advance), LONGEST_LEG), leg.step.advance)
            return Leg(PlanarStep(leg.step.turn, advance), leg.share, leg.sees_thing)
    return None


async def drive(run: FetchRun, leg: Leg) -> str:
    """Drive a leg with the arm folded, following the thing and estimating on (see Ways); return what blocks
    the robot, '' for nothing. Raises TargetLost.
    """
    assert run.locating is not None
    run.remember(way=(*run.memory.way, run.here))
    folded = run.context.description.arm.standard.pose()
    motion = run.context.pilot.move(leg.step, folded)
    if run.ways.renews_on_way:
        return await run.locating.drive(motion)
    await motion
    return ""
