"""The phases with the claw at the thing: reaching out, closing, lifting, and letting go to try again."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.approach import NEAR_SHARE, Approach
from tapreach.tasks.fetch.arm_leading import ArmBlocked, fold, lead, lead_straight, lead_to
from tapreach.tasks.fetch.arm_workspace import Unreachable
from tapreach.tasks.fetch.grip_motion import LIFT_SPEED, closed, lift_path
from tapreach.tasks.fetch.looking import end_following
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.thing import ThingSize
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.task import Tap

REACH_SPEED = 0.06
"""Of the claw around the thing [m/s]."""
BACK_OFF = 0.15
"""How far the robot backs off to look again [m], where the way behind is free."""
LEAN = 0.008
"""The gripping point goes so far short of the middle [m]: a box may be less deep than it is wide, and a claw
too deep meets it with its palm; the fingers reach beyond the middle all the same.
"""
_MOST_CORRECTIONS = 2
_LEAST_CORRECTION, _MOST_MISSING = 0.008, 0.05


@dataclass(frozen=True)
class ClawWay:
    """tips in the arm's base frame, (3,) [m]: before the thing's front, and around it."""

    before: FloatArray
    around: FloatArray


async def reach(run: FetchRun) -> Ended:
    """Bring the open claw around the thing. Raises MotionInterrupted, LinkLost."""
    assert run.preview is not None and run.preview.approach is not None and run.locating is not None
    way = run.preview.approach
    before, _ = way.stance.tips(run.claw)
    pose = run.arm.pose_at(before, way.stance.grip.opening)
    try:
        if isinstance(pose, Unreachable):
            raise ArmBlocked(pose.reason)
        await lead_to(run, pose, [run.context.description.arm.stowed.pose()])
        await run.context.pilot.advance(way.last_stretch.step.advance, NEAR_SHARE)
        aim = await _come_right(run, way)
        await lead_straight(run, aim.before)
        await lead_straight(run, aim.around, REACH_SPEED)
    except ArmBlocked as blocked:
        return Ended(Outcome.CANNOT, f"the arm does not get there: {blocked}")
    return Ended(Outcome.DONE, "the claw is around it")


async def grip(run: FetchRun) -> Ended:
    """Close the claw on the thing."""
    size = run.size
    assert isinstance(size, ThingSize)
    pose = closed(await run.arm_watch.target(), size.width, size.width_sd)
    await run.context.pilot.move_arm(pose)
    run.remember(gripped_at=pose)
    return Ended(Outcome.DONE, "the claw is closed")


async def lift(run: FetchRun) -> Ended:
    """Lift what is in the claw."""
    path = lift_path(await run.arm_watch.target(), run.arm)
    if isinstance(path, Unreachable):
        return Ended(Outcome.CANNOT, path.reason)
    await lead(run, path, LIFT_SPEED)
    return Ended(Outcome.DONE, "lifted")


async def back_off(run: FetchRun) -> Ended:
    """Let go, back off, fold the arm and find the thing again."""
    try:
        await let_go(run)
        await run.context.pilot.advance(-min(BACK_OFF, way_behind(run.context.poses)))
        await fold(run)
    except ArmBlocked as blocked:
        return Ended(Outcome.CANNOT, f"the arm does not get free: {blocked}")
    if run.locating is None:
        _let_be_moved(run)
        return Ended(Outcome.DONE, "looks for it where it was")
    sighting = await run.locating.follower.look()
    tap = None if sighting is None else Tap(sighting.frame_id, sighting.pixel.u, sighting.pixel.v)
    if tap is None and run.memory.known is None:
        loss = run.locating.follower.loss
        return Ended(Outcome.LOST, f"it is not seen any more ({loss}): it may have moved. Tap it again")
    await end_following(run)
    _let_be_moved(run)
    run.remember(seen_again=tap)
    return Ended(Outcome.DONE, "it is seen again" if tap is not None else "looks for it where it was")


def _let_be_moved(run: FetchRun) -> None:
    """Know the thing's place only as well as after a grip that may have pushed it."""
    if run.memory.known is not None:
        run.remember(known=run.memory.known.pushed())


async def _come_right(run: FetchRun, way: Approach) -> ClawWay:
    """Drive what is still missing to where the arm reaches the thing, and return where the claw goes."""
    grip = way.stance.grip
    for _ in range(_MOST_CORRECTIONS):
        missing = _ahead_of_turret(run) - LEAN - grip.ahead
        if abs(missing) < max(_LEAST_CORRECTION, grip.spare / 2.0):
            break
        if abs(missing) > _MOST_MISSING:
            raise ArmBlocked(f"the thing is {100.0 * missing:.0f} cm from where it should be by now")
        await run.context.pilot.advance(missing, NEAR_SHARE)
    return aim(run, way)


def aim(run: FetchRun, way: Approach) -> ClawWay:
    """Return where the claw goes for the thing where it is now known to be, with the base where it stands: a
    little short of its middle.
    """
    grip = way.stance.grip
    axis = run.in_base(run.axis_in_world())
    off = axis[:2] - run.claw.turret
    rotation, ahead = math.atan2(off[1], off[0]), float(np.hypot(*off)) - LEAN
    behind = ahead - (grip.ahead - grip.pre_grasp)
    tips = (run.claw.tip(each, grip.height, rotation) for each in (behind, ahead))
    return ClawWay(*tips)


def _ahead_of_turret(run: FetchRun) -> float:
    return float(np.hypot(*(run.in_base(run.axis_in_world())[:2] - run.claw.turret)))


async def let_go(run: FetchRun) -> None:
    """Open the claw where it is and draw it back from what stood in it."""
    pose: ArmPose = await run.arm_watch.target()
    open_pose = replace(pose, claw=run.arm.claw_max)
    await run.context.pilot.move_arm(open_pose)
    inwards = np.array([math.cos(pose.rotation), math.sin(pose.rotation), 0.0])
    tip = run.arm.tip(open_pose)
    for back in (0.08, 0.05, 0.03):
        try:
            await lead_straight(run, tip - back * inwards)
            return
        except ArmBlocked:
            continue
