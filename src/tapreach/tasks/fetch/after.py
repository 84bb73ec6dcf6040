"""What can be done with a thing that is held: bring it back, put it down, hand it over, let it go."""

import math
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace

import numpy as np

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep, wrapped
from tapreach.tasks.fetch.arm_leading import ArmBlocked, fold, lead_straight
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.fetch_state import FetchState, Verb
from tapreach.tasks.fetch.gripping import BACK_OFF, let_go
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.states import Phase
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.task import TaskContext, TaskReport

OFFERED_HEIGHTS = (0.26, 0.22, 0.18, 0.14)
OFFERED_AHEAD = (0.20, 0.16, 0.12)
"""Where a thing is handed over [m]: the highest, then the farthest ahead of the turret that is reached."""
LOWER_SPEED = 0.05
"""[m/s]"""
_LEAST_WAY, _LEAST_TURN = 0.02, math.radians(3.0)


class FollowUp:
    """One of the verbs, on what a fetch has gripped. Raises ArmBlocked, MotionInterrupted, LinkLost."""

    def __init__(self, verb: Verb, memory: FetchMemory) -> None:
        self._verb = verb
        self._memory = memory

    @property
    def kind(self) -> str:
        """See Task."""
        return self._verb.value

    async def run(self, context: TaskContext) -> str:
        """See Task. Shows what can be done with the thing afterwards."""
        run = FetchRun(context, self._memory, (), ArmWatch(context.robot.arm))
        context.report(TaskReport(self._verb.value, 0.0, _SAYS[self._verb]))
        try:
            why, verbs = await _ACTS[self._verb](run)
        finally:
            run.arm_watch.end()
        memory = self._memory
        is_held = bool(verbs)
        context.show_fetch(
            FetchState(Phase.HELD, memory.target_id, why, memory.attempt, verbs=verbs) if is_held else None
        )
        return why


After = tuple[str, tuple[Verb, ...]]


async def _bring_back(run: FetchRun) -> After:
    """Drive back over the places where it was, to where it was called, facing as it did then."""
    for place in _places_back(run.memory):
        step = _step_to(run.here, place)
        await run.context.pilot.turn(step.turn)
        await run.context.pilot.advance(step.advance)
    called_from = run.memory.called_from or run.here
    await run.context.pilot.turn(wrapped(called_from.heading - run.here.heading))
    return "it is back where it was called", (Verb.PUT_DOWN, Verb.HAND_OVER)


async def _put_down(run: FetchRun) -> After:
    """Lower the thing to the height at which it was gripped, let go, draw back and fold the arm."""
    pose = await run.arm_watch.target()
    gripped = run.memory.gripped_at
    tip = run.arm.tip(pose)
    if gripped is not None:
        tip = np.array([tip[0], tip[1], run.arm.tip(gripped)[2]])
    await lead_straight(run, tip, LOWER_SPEED)
    await let_go(run)
    await run.context.pilot.advance(-min(BACK_OFF, way_behind(run.context.poses)))
    await fold(run)
    return "it is put down", ()


async def _hand_over(run: FetchRun) -> After:
    """Hold the thing out, as high and as far ahead as the arm reaches."""
    rotation = (await run.arm_watch.target()).rotation
    for height in OFFERED_HEIGHTS:
        for ahead in OFFERED_AHEAD:
            try:
                await lead_straight(run, run.claw.tip(ahead, height, rotation), LOWER_SPEED)
            except ArmBlocked:
                continue
            return "it is held out: take hold of it, then let it go", (Verb.LET_GO, Verb.PUT_DOWN)
    raise ArmBlocked("the arm cannot hold it out from where it is")


async def _let_go(run: FetchRun) -> After:
    """Open the claw, where somebody takes the thing."""
    pose = await run.arm_watch.target()
    await run.context.pilot.move_arm(replace(pose, claw=run.arm.claw_max))
    await fold(run)
    return "the claw is open", ()


_ACTS: Mapping[Verb, Callable[[FetchRun], Awaitable[After]]] = {
    Verb.BRING_BACK: _bring_back,
    Verb.PUT_DOWN: _put_down,
    Verb.HAND_OVER: _hand_over,
    Verb.LET_GO: _let_go,
}
_SAYS: Mapping[Verb, str] = {
    Verb.BRING_BACK: "brings it back to where it was called",
    Verb.PUT_DOWN: "puts it down",
    Verb.HAND_OVER: "holds it out",
    Verb.LET_GO: "lets it go",
}


def _places_back(memory: FetchMemory) -> list[PlanarPose]:
    """Return where it was on the way, the newest first, ending where it was called."""
    called = (memory.called_from,) if memory.called_from is not None else ()
    return list(reversed((*called, *memory.way)))


def _step_to(here: PlanarPose, place: PlanarPose) -> PlanarStep:
    """Return the turn and the advance to a place, whatever the heading there."""
    way = here.between(place)
    distance = math.hypot(way.x, way.y)
    if distance < _LEAST_WAY:
        return PlanarStep(0.0, 0.0)
    bearing = math.atan2(way.y, way.x)
    return PlanarStep(0.0 if abs(bearing) < _LEAST_TURN else bearing, distance)
