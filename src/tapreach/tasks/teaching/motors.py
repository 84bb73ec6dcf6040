"""Do motors turn the way they are told, and do encoders count that way? Slowly, wheels off the ground.

The wheels are driven without feedback: an encoder the wrong way round would make a speed control run away.
"""

from dataclasses import dataclass, field
from typing import get_args

from tapreach.robot.link_section import Part
from tapreach.robot.teachable import Bench, Side
from tapreach.tasks.teaching.finding import Finding
from tapreach.tasks.teaching.person import Person

SIDES: tuple[Side, ...] = ("left", "right")
OTHER: dict[Side, Side] = {"left": "right", "right": "left"}
MOTOR: dict[Side, Part] = {"left": "left_motor", "right": "right_motor"}
ENCODER: dict[Side, Part] = {"left": "left_encoder", "right": "right_encoder"}
FEW_TICKS = 10
NOT_TAKEN = "The board did not take its wheel control back: switch it off and on before you drive."


@dataclass
class _Seen:
    to_wire: list[str] = field(default_factory=list)
    wrong: list[Part] = field(default_factory=list)


async def try_motors(bench: Bench, person: Person, reversed_parts: tuple[Part, ...]) -> Finding:
    """Turn each wheel for a second and return what came of it.

    reversed_parts: what the robot file says is the other way round; the board makes up for that already.
    Raises TeachingStopped, and what a Bench raises.
    """
    person.tell("One wheel after the other turns forward for a second, slowly.")
    await person.ask("Are both wheels off the ground, and free?", ("yes",))
    await bench.take_feedback_off()
    try:
        seen = _Seen()
        for side in SIDES:
            await _test_side(bench, person, side, seen)
    finally:
        if not await bench.give_feedback_back():
            person.tell(NOT_TAKEN)
    return _finding(seen, reversed_parts)


def _finding(seen: _Seen, reversed_parts: tuple[Part, ...]) -> Finding:
    if seen.to_wire:
        return Finding(to_wire=tuple(seen.to_wire))
    turned_round = turned(reversed_parts, tuple(seen.wrong))
    if set(turned_round) == set(reversed_parts):
        return Finding(words="Motors and encoders are right.")
    return Finding(
        words="The board can make up for what is the other way round:",
        changes={("link", "reversed"): list(turned_round)},
        if_written="Test again after that: all is right then.",
        if_not="Swap wires then, and test again.",
    )


def turned(parts: tuple[Part, ...], more: tuple[Part, ...]) -> tuple[Part, ...]:
    """Return the parts that are the other way round where `more` turned out wrong with `parts` reversed."""
    return tuple(part for part in get_args(Part) if (part in parts) != (part in more))


async def _test_side(bench: Bench, person: Person, side: Side, seen: _Seen) -> None:
    await person.ask(f"The {side} wheel now?", ("yes",))
    before = bench.ticks()
    await bench.spin(side)
    ticks = bench.ticks().since(before)
    told = await person.ask("Which wheel turned?", ("left", "right", "none"))
    if told == "none":
        seen.to_wire.append(f"{side} motor: no motion; check its supply, its enable pin and its cable")
        return
    turning: Side = "left" if told == "left" else "right"
    if turning != side:
        seen.to_wire.append(
            f"the {turning} wheel turns when the {side} one should: swap the two motors at the bridge"
        )
    way = await person.ask("Did it turn forward or back?", ("forward", "back"))
    if way == "back":
        seen.wrong.append(MOTOR[turning])
    _judge_encoder(turning, 1 if way == "forward" else -1, ticks, seen)


def _judge_encoder(turning: Side, sign: int, ticks: dict[Side, int], seen: _Seen) -> None:
    counted = sign * ticks[turning]
    if abs(counted) >= FEW_TICKS:
        if counted < 0:
            seen.wrong.append(ENCODER[turning])
    elif abs(ticks[OTHER[turning]]) >= FEW_TICKS:
        seen.to_wire.append(
            f"the {OTHER[turning]} encoder counts the {turning} wheel: swap the two encoders at the board"
        )
    else:
        seen.to_wire.append(f"{turning} encoder counts nothing: check its supply and its cable")
