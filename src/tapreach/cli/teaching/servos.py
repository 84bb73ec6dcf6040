"""Servo limits, directions and zeros: small steps, each asked for by the person."""

from dataclasses import dataclass
from typing import Literal

from tapreach.cli.teaching.file_changes import Changes
from tapreach.cli.teaching.person import Person
from tapreach.drivers.arduino.servos import Pulses, ServoMap, values_of
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wire import ServoLimits, Servos
from tapreach.errors import DriverError, InputError
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.servo_section import LONGEST_US, SHORTEST_US

STEPS_US = {"-": -10, "+": 10, "--": -50, "++": 50}
SPEED_US_PER_S = 150
"""About 15 degrees a second."""
DIRECTION_US = 80
ARRIVED_US, ARRIVAL_NS = 3, 20 * SECOND
Index = Literal[0, 1, 2, 3]


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and what a person calls its directions and its zero."""

    index: Index
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


async def teach_servos(visit: BoardVisit, person: Person, arm: ArmSection) -> Changes:
    """Go through the four joints and return what to write. Raises TeachingStopped, LinkLost, DriverError."""
    rests = rest_pulses(arm)
    person.tell(
        "Each servo goes to its rest pulse first, at once: the arm must be free all around.\n"
        "Then it goes by small steps that you ask for: - and + are 10 µs, -- and ++ 50 µs."
    )
    changes: dict[tuple[str, ...], bool | int | float | list[str]] = {}
    for joint in JOINTS:
        question = f"\nServo {'ABCD'[joint.index]}, {joint.name}: rest is {rests[joint.index]} µs. Move it?"
        if await person.ask(question, ("yes", "skip")) == "yes":
            changes |= await _teach_joint(visit, person, joint, rests[joint.index])
    return changes


def rest_pulses(arm: ArmSection) -> Pulses:
    """Return the pulses of the stowed pose."""
    servos = ServoMap(arm).servos
    a, b, c, d = (s.pulse_us(v) for s, v in zip(servos, values_of(arm.stowed.pose()), strict=True))
    return a, b, c, d


async def _teach_joint(visit: BoardVisit, person: Person, joint: Joint, rest_us: int) -> Changes:
    await visit.require(ServoLimits(joint.index, SHORTEST_US, LONGEST_US, rest_us))
    at_us = await _go(visit, joint.index, rest_us)
    at_us = low_us = await _jog(visit, person, joint, at_us, "the end of its way with the shorter pulse")
    at_us = high_us = await _jog(visit, person, joint, at_us, "the end of its way with the longer pulse")
    if high_us - low_us < 2 * DIRECTION_US:
        raise InputError(f"{joint.name}: from {low_us} to {high_us} µs is no way to go; nothing was written")
    middle_us = max(low_us, min(high_us - DIRECTION_US, round((low_us + high_us - DIRECTION_US) / 2)))
    await _go(visit, joint.index, middle_us)
    is_reversed = await _is_reversed(visit, person, joint, middle_us)
    zero_us = await _jog(visit, person, joint, middle_us + DIRECTION_US, joint.zero, low_us, high_us)
    end_us = await _go(visit, joint.index, max(low_us, min(high_us, rest_us)))
    await visit.require(ServoLimits(joint.index, low_us, high_us, end_us))
    at = ("arm", "servos", joint.name)
    return {
        (*at, "low_us"): low_us,
        (*at, "high_us"): high_us,
        (*at, "reversed"): is_reversed,
        (*at, "pulse_at_zero_us"): zero_us,
    }


async def _is_reversed(visit: BoardVisit, person: Person, joint: Joint, from_us: int) -> bool:
    await person.ask("Look at it: it goes a little with a longer pulse. Ready?", ("yes",))
    await _go(visit, joint.index, from_us + DIRECTION_US)
    ways = (joint.positive, joint.negative)
    return await person.ask("Which way was that?", ways) == joint.negative


async def _jog(
    visit: BoardVisit,
    person: Person,
    joint: Joint,
    at_us: int,
    goal: str,
    low_us: int = SHORTEST_US,
    high_us: int = LONGEST_US,
) -> int:
    person.tell(f"Go by steps until {goal}; a servo that hums presses against something: go back.")
    while (said := await person.ask(f"{at_us} µs", (*STEPS_US, "ok"))) != "ok":
        wanted_us = max(low_us, min(high_us, at_us + STEPS_US[said]))
        at_us = await _go(visit, joint.index, wanted_us)
    return at_us


async def _go(visit: BoardVisit, index: Index, pulse_us: int) -> int:
    """Send one servo there, slowly, and wait until it is."""
    pulses, speeds = [0, 0, 0, 0], [0, 0, 0, 0]
    pulses[index], speeds[index] = pulse_us, SPEED_US_PER_S
    a, b, c, d = pulses
    e, f, g, h = speeds
    await visit.require(Servos((a, b, c, d), (e, f, g, h)))
    arrived = await visit.until(lambda: _is_there(visit, index, pulse_us), ARRIVAL_NS)
    if not arrived:
        raise DriverError(f"the board did not bring servo {'ABCD'[index]} to {pulse_us} µs: {visit.reason}")
    await visit.pause(100 * MS)
    return pulse_us


def _is_there(visit: BoardVisit, index: Index, pulse_us: int) -> bool:
    told = visit.telemetry
    return told is not None and abs(told.pulse_us[index] - pulse_us) <= ARRIVED_US
