"""How many ticks is a turn of a wheel? Turned by hand: the motors stay off."""

from tapreach.cli.teaching.file_changes import Changes
from tapreach.cli.teaching.motors import SIDES
from tapreach.cli.teaching.person import Person
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wire import Fault, Feature
from tapreach.errors import DriverError, InputError, LinkLost
from tapreach.robot.clock import MS

TURNS = 5
FEWEST = 4.0
"""Ticks of a turn below which a wheel was not turned, or its encoder is of no use."""
AGREEMENT = 0.02
"""What five turns by hand differ by: a tenth of a turn."""
SETTLE_NS = 300 * MS


async def count_encoders(visit: BoardVisit, person: Person) -> Changes:
    """Return the ticks of a turn, the mean of both wheels.

    Raises TeachingStopped, LinkLost, and InputError where the count makes no sense, with what to do.
    """
    if visit.welcome is not None and Feature.STEPPER in visit.welcome.features:
        raise InputError("this board drives steppers: a turn is its motor's steps times the micro steps")
    person.tell(f"The motors stay off. Mark each wheel; you turn it {TURNS} times forward by hand.")
    per_turn = {side: await _count(visit, person, side) for side in SIDES}
    left, right = per_turn["left"], per_turn["right"]
    if abs(left - right) > AGREEMENT * max(left, right):
        raise InputError(
            f"left {left:g} and right {right:g} ticks a turn differ too much: turn them again, marks exactly "
            "at the same place; where it stays so, one encoder loses counts"
        )
    return {("base", "ticks_per_turn"): round((left + right) / 2)}


async def _count(visit: BoardVisit, person: Person, side: str) -> float:
    await person.ask(f"\nThe {side} wheel stands with its mark where you can find it again?", ("yes",))
    before = _ticks(visit, side)
    await person.ask(f"Turn it {TURNS} times forward, mark to mark. Done?", ("yes",))
    await visit.pause(SETTLE_NS)
    ticks = (_ticks(visit, side) - before + 2**31) % 2**32 - 2**31
    per_turn = ticks / TURNS
    if abs(per_turn) < FEWEST:
        raise InputError(f"the {side} encoder counted {ticks} ticks: check its supply and its cable")
    if per_turn < 0:
        raise InputError(
            f"the {side} encoder counted back ({ticks} ticks): hold the lesson of the motors first"
        )
    person.tell(f"{ticks} ticks: {per_turn:g} a turn.")
    return per_turn


def _ticks(visit: BoardVisit, side: str) -> int:
    told = visit.telemetry
    if told is None:
        raise LinkLost(visit.reason)
    if Fault.ENCODER_ILLEGAL in told.faults:
        raise DriverError("an encoder counts what cannot be: check its cable and its supply")
    return told.left if side == "left" else told.right
