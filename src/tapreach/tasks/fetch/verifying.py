"""The phase in which the robot looks whether it holds the thing."""

from dataclasses import replace

from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_zero import ArmZero
from tapreach.tasks.fetch.by_colours import is_seen_there
from tapreach.tasks.fetch.claw_show_room import WORTH_BACKING, lacking_room
from tapreach.tasks.fetch.held import Held, HeldVerdict, held_away, least_opening, look_whether_held
from tapreach.tasks.fetch.looking_again import frame_from_now_on
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.thing import ThingSize
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.free_way import way_behind


async def verify(run: FetchRun) -> Ended:
    """Look whether the thing is in the claw, which then stays closed at the height to which it was lifted.

    It backs off meanwhile from where the thing stood: one that still stands there would be hit by the claw.
    Where the claw itself does not tell, it counts whether the thing is seen where it was; what neither tells
    counts as not held: it is looked for again. A claw that was never seen tells nothing at all.
    """
    back = min(lacking_room(run), way_behind(run.context.poses))
    if back > WORTH_BACKING:
        await run.context.pilot.advance(-back)
    lifted = await run.arm_watch.target()
    ended = await (_by_place(run) if run.memory.zero is None else _by_claw(run, run.memory.zero))
    await run.context.pilot.move_arm(replace(lifted, claw=(await run.arm_watch.target()).claw))
    if ended.outcome is Outcome.MISSED:
        missed = run.here.heading + lifted.rotation
        run.remember(missed_from=(*run.memory.missed_from, missed))
    elif back > WORTH_BACKING:
        await run.context.pilot.advance(back)
    return ended


async def _by_claw(run: FetchRun, zero: ArmZero) -> Ended:
    width = run.size.width if isinstance(run.size, ThingSize) else 0.0
    found = await look_whether_held(run.context, zero, width)
    if found.verdict is HeldVerdict.UNSURE and _is_apart(run, found, width):
        return await _by_place(run)
    is_held = found.verdict is HeldVerdict.HELD
    return Ended(Outcome.DONE if is_held else Outcome.MISSED, found.reason)


def _is_apart(run: FetchRun, found: Held, width: float) -> bool:
    return width > 0.0 and found.opening >= least_opening(width, run.context.description)


async def _by_place(run: FetchRun) -> Ended:
    """Tell by whether the thing is seen where it stood, past the claw."""
    away = held_away(run.context.description, run.memory.zero)
    if away is not None:
        claw = (await run.arm_watch.target()).claw
        await run.context.pilot.move_arm(ArmPose(away.rotation, away.shoulder, away.elbow, claw))
    frame = await frame_from_now_on(run.context)
    if await is_seen_there(run, frame, await pose_at(run.context, frame.captured_ns)):
        return Ended(Outcome.MISSED, "it still stands where it was")
    return Ended(Outcome.DONE, "lifted, and not seen any more where it stood")
