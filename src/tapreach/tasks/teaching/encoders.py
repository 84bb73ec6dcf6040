"""How many ticks is a turn of a wheel? Turned by hand: the motors stay off."""

from tapreach.errors import InputError
from tapreach.robot.clock import MS
from tapreach.robot.teachable import Bench, Side
from tapreach.tasks.teaching.finding import Finding
from tapreach.tasks.teaching.motors import SIDES
from tapreach.tasks.teaching.person import Person

TURNS = 5
FEWEST = 4.0
"""Ticks of a turn below which a wheel was not turned, or its encoder is of no use."""
AGREEMENT = 0.02
"""What five turns by hand differ by: a tenth of a turn."""
SETTLE_NS = 300 * MS


async def count_encoders(bench: Bench, person: Person) -> Finding:
    """Return the ticks of a turn, the mean of both wheels.

    Raises TeachingStopped, what a Bench raises, and InputError where the count makes no sense, with what to
    do.
    """
    if not bench.counts_turns:
        raise InputError("this board drives steppers: a turn is its motor's steps times the micro steps")
    person.tell(f"The motors stay off. Mark each wheel; you turn it {TURNS} times forward by hand.")
    per_turn = {side: await _count(bench, person, side) for side in SIDES}
    left, right = per_turn["left"], per_turn["right"]
    if abs(left - right) > AGREEMENT * max(left, right):
        raise InputError(
            f"left {left:g} and right {right:g} ticks a turn differ too much: turn them again, marks exactly "
            "at the same place; where it stays so, one encoder loses counts"
        )
    return Finding(changes={("base", "ticks_per_turn"): round((left + right) / 2)})


async def _count(bench: Bench, person: Person, side: Side) -> float:
    await person.ask(f"The {side} wheel stands with its mark where you can find it again?", ("yes",))
    before = bench.ticks()
    await person.ask(f"Turn it {TURNS} times forward, mark to mark. Done?", ("yes",))
    await bench.pause(SETTLE_NS)
    ticks = bench.ticks().since(before)[side]
    per_turn = ticks / TURNS
    if abs(per_turn) < FEWEST:
        raise InputError(f"the {side} encoder counted {ticks} ticks: check its supply and its cable")
    if per_turn < 0:
        raise InputError(
            f"the {side} encoder counted back ({ticks} ticks): hold the lesson of the motors first"
        )
    person.tell(f"{side.capitalize()} wheel: {ticks} ticks, {per_turn:g} a turn.")
    return per_turn
