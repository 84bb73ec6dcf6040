"""Servo limits, directions and zeros: small steps, each asked for by the person."""

from dataclasses import dataclass

from tapreach.errors import InputError
from tapreach.robot.servo_section import LONGEST_US, SHORTEST_US
from tapreach.robot.teachable import Bench, ServoIndex
from tapreach.tasks.teaching.file_changes import Changes
from tapreach.tasks.teaching.finding import Finding
from tapreach.tasks.teaching.person import Person

STEPS_US = {"-": -10, "+": 10, "--": -50, "++": 50}
DIRECTION_US = 80


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and what a person calls its directions and its zero."""

    index: ServoIndex
    name: str
    positive: str
    negative: str
    zero: str


JOINTS = (
    Joint(0, "rotation", "left", "right", "the arm points straight ahead"),
    Joint(1, "shoulder", "forward", "back", "the upper arm is upright"),
    Joint(2, "elbow", "down", "up", "the forearm is at a right angle to the upper arm"),
    Joint(3, "claw", "open", "shut", "the claw is just closed, without pressing"),
)


async def teach_servos(bench: Bench, person: Person) -> Finding:
    """Go through the four joints and return what to write. Raises TeachingStopped, what a Bench raises."""
    person.tell(
        "Each servo goes to its rest pulse first, at once: the arm must be free all around.\n"
        "Then it goes by small steps that you ask for: - and + are 10 µs, -- and ++ 50 µs."
    )
    changes: dict[tuple[str, ...], bool | int | float | list[str]] = {}
    for joint in JOINTS:
        rest_us = bench.rest_us(joint.index)
        question = f"Servo {'ABCD'[joint.index]}, {joint.name}: rest is {rest_us} µs. Move it?"
        if await person.ask(question, ("yes", "skip")) == "yes":
            changes |= await _teach_joint(bench, person, joint, rest_us)
    return Finding(changes=changes)


async def _teach_joint(bench: Bench, person: Person, joint: Joint, rest_us: int) -> Changes:
    await bench.limit_servo(joint.index, SHORTEST_US, LONGEST_US)
    at_us = await _go(bench, joint, rest_us)
    at_us = low_us = await _jog(bench, person, joint, at_us, "the end of its way with the shorter pulse")
    at_us = high_us = await _jog(bench, person, joint, at_us, "the end of its way with the longer pulse")
    if high_us - low_us < 2 * DIRECTION_US:
        raise InputError(f"{joint.name}: from {low_us} to {high_us} µs is no way to go; nothing was written")
    middle_us = max(low_us, min(high_us - DIRECTION_US, round((low_us + high_us - DIRECTION_US) / 2)))
    await _go(bench, joint, middle_us)
    is_reversed = await _is_reversed(bench, person, joint, middle_us)
    zero_us = await _jog(bench, person, joint, middle_us + DIRECTION_US, joint.zero, low_us, high_us)
    await _go(bench, joint, max(low_us, min(high_us, rest_us)))
    await bench.limit_servo(joint.index, low_us, high_us)
    at = ("arm", "servos", joint.name)
    return {
        (*at, "low_us"): low_us,
        (*at, "high_us"): high_us,
        (*at, "reversed"): is_reversed,
        (*at, "pulse_at_zero_us"): zero_us,
    }


async def _is_reversed(bench: Bench, person: Person, joint: Joint, from_us: int) -> bool:
    await person.ask("Look at it: it goes a little with a longer pulse. Ready?", ("yes",))
    await _go(bench, joint, from_us + DIRECTION_US)
    ways = (joint.positive, joint.negative)
    return await person.ask("Which way was that?", ways) == joint.negative


async def _jog(
    bench: Bench,
    person: Person,
    joint: Joint,
    at_us: int,
    goal: str,
    low_us: int = SHORTEST_US,
    high_us: int = LONGEST_US,
) -> int:
    person.tell(f"Go by steps until {goal}; a servo that hums presses against something: go back.")
    while (said := await person.ask(f"{at_us} µs", (*STEPS_US, "ok"))) != "ok":
        at_us = await _go(bench, joint, max(low_us, min(high_us, at_us + STEPS_US[said])))
    return at_us


async def _go(bench: Bench, joint: Joint, pulse_us: int) -> int:
    await bench.send_servo(joint.index, pulse_us)
    return pulse_us
