"""An operator who stops a fetch at a random moment, looks what becomes of it, and lets it go on."""

import math
from dataclasses import replace

import numpy as np

from tapreach.bench.fetch_outcome import StopOutcome
from tapreach.bench.fetch_truth import Standing, foot_height, is_between_fingers
from tapreach.bench.fetch_witness import Witness
from tapreach.bench.running_robot import RunningRobot
from tapreach.drivers.sim.truth import WorldTruth, ask_truth
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import STILL

EARLIEST_S, LATEST_S = 0.3, 40.0
"""A stop comes at any moment between these after the tap, all alike."""
AFTER_S = 2.0
"""How long one looks what becomes of it."""
_OFF_FLOOR = 0.005
_AT_REST = 0.002
"""Moves by less in 0.1 s: it stands [m, rad]."""
_LONGEST_S = 2.0


def draw_moment(rng: np.random.Generator) -> float:
    """Return when the operator stops, after the tap [s]."""
    return float(rng.uniform(EARLIEST_S, LATEST_S))


async def stop_now(running: RunningRobot, witness: Witness, standing: Standing) -> StopOutcome:
    """Stop the fetch that runs and return what becomes of it; it has not been resumed then."""
    before = await ask_truth(running.robot)
    seconds, phase = witness.seconds, witness.phase
    running.runner.cancel("the operator stops")
    zero_ms = await _until_zero(running)
    rest_ms = zero_ms + await _until_rest(running)
    await running.advance(AFTER_S)
    after = await ask_truth(running.robot)
    return StopOutcome(
        seconds=seconds,
        phase=phase.value if phase is not None else "",
        zero_ms=zero_ms,
        rest_ms=rest_ms,
        was_held=_is_in_claw(standing, before),
        is_held=_is_in_claw(standing, after),
        flung=max(replace(standing, before=before).moves(after).values(), default=0.0),
        resumed=False,
    )


async def _until_zero(running: RunningRobot) -> float:
    """Return how long it takes until zero is sent to the wheels [ms]."""
    began_ns = running.clock.now_ns()
    while running.loop.sent.twist != STILL and running.clock.now_ns() - began_ns < _LONGEST_S * SECOND:
        await running.clock.advance(5 * MS)
    return (running.clock.now_ns() - began_ns) / MS


async def _until_rest(running: RunningRobot) -> float:
    """Return how long it takes until the base truly stands [ms], to 0.1 s."""
    began_ns = running.clock.now_ns()
    last = await ask_truth(running.robot)
    while running.clock.now_ns() - began_ns < _LONGEST_S * SECOND:
        at_ns = running.clock.now_ns()
        await running.advance(0.1)
        now = await ask_truth(running.robot)
        step = last.base_pose.between(now.base_pose)
        if math.hypot(step.x, step.y) < _AT_REST and abs(step.heading) < _AT_REST:
            return (at_ns - began_ns) / MS
        last = now
    return (running.clock.now_ns() - began_ns) / MS


def _is_in_claw(standing: Standing, now: WorldTruth) -> bool:
    foot = foot_height(now.object(standing.thing)) - foot_height(standing.before.object(standing.thing))
    return foot > _OFF_FLOOR and is_between_fingers(now, standing.thing)
