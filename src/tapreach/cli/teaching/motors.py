"""Do motors turn the way they are told, and do encoders count that way? Slowly, wheels off the ground.

The wheels are driven without feedback: an encoder the wrong way round would make a speed control run away.
"""

from dataclasses import dataclass, field
from typing import Literal

from tapreach.cli.teaching.person import Person
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wire import Drive, Gains, Stop
from tapreach.drivers.arduino.wiring import turned
from tapreach.errors import DriverError, LinkLost
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.link_section import LinkSection, Part

Side = Literal["left", "right"]
SIDES: tuple[Side, ...] = ("left", "right")
OTHER: dict[Side, Side] = {"left": "right", "right": "left"}
MOTOR: dict[Side, Part] = {"left": "left_motor", "right": "right_motor"}
ENCODER: dict[Side, Part] = {"left": "left_encoder", "right": "right_encoder"}
SPEED, ACCELERATION, PWM = 300, 600, 110
"""[ticks/s], [ticks/s²] and the PWM of 255 that this speed stands for while there is no feedback."""
SPIN_NS, EVERY_NS, REST_NS = 1 * SECOND, 50 * MS, 500 * MS
FEW_TICKS = 10
FIRMWARE_GAINS = Gains(20, 200, 0, 20, 4000, 8000)
"""Those the firmware starts with (control.h): given back where the robot file has none."""
WITHOUT_FEEDBACK = Gains(0, 0, 0, round(256 * PWM / SPEED), SPEED, ACCELERATION)


@dataclass(frozen=True, slots=True)
class MotorFindings:
    """What has to be wired otherwise, and which parts the board is to turn round by the robot file."""

    to_wire: tuple[str, ...]
    reversed: tuple[Part, ...]


@dataclass
class _Seen:
    to_wire: list[str] = field(default_factory=list)
    wrong: list[Part] = field(default_factory=list)


async def try_motors(visit: BoardVisit, person: Person, link: LinkSection) -> MotorFindings:
    """Turn each wheel for a second and return what came of it; the board has been told link.reversed.

    Raises TeachingStopped, LinkLost, DriverError.
    """
    person.tell("One wheel after the other turns forward for a second, slowly.")
    await person.ask("Are both wheels off the ground, and free?", ("yes",))
    await visit.require(WITHOUT_FEEDBACK)
    try:
        seen = _Seen()
        for side in SIDES:
            await _test_side(visit, person, side, seen)
        return MotorFindings(tuple(seen.to_wire), turned(link.reversed, tuple(seen.wrong)))
    finally:
        await _give_gains_back(visit, person, link)


async def _test_side(visit: BoardVisit, person: Person, side: Side, seen: _Seen) -> None:
    await person.ask(f"\nThe {side} wheel now?", ("yes",))
    ticks = await _spin(visit, side)
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


async def _spin(visit: BoardVisit, side: Side) -> dict[Side, int]:
    """Turn one wheel and return the ticks of both."""
    await visit.require(Drive(0, 0, visit.session.at_ms))
    before = _ticks(visit)
    left, right = (SPEED if side == each else 0 for each in SIDES)
    for _ in range(SPIN_NS // EVERY_NS):
        visit.session.send(Drive(left, right, visit.session.at_ms))
        await visit.pause(EVERY_NS)
    await visit.require(Stop())
    await visit.pause(REST_NS)
    after = _ticks(visit)
    return {each: _difference(after[each], before[each]) for each in SIDES}


def _ticks(visit: BoardVisit) -> dict[Side, int]:
    told = visit.telemetry
    if told is None:
        raise LinkLost(visit.reason)
    if told.faults:
        raise DriverError("a fault stands: tapreach doctor says which")
    return {"left": told.left, "right": told.right}


def _difference(after: int, before: int) -> int:
    """Return ticks that have come since; the count wraps at 32 bits."""
    return (after - before + 2**31) % 2**32 - 2**31


async def _give_gains_back(visit: BoardVisit, person: Person, link: LinkSection) -> None:
    control = link.wheel_control
    gains = FIRMWARE_GAINS
    if control is not None:
        parts = (control.kp, control.ki, control.kd, control.feedforward)
        kp, ki, kd, feedforward = (round(256 * part) for part in parts)
        gains = Gains(kp, ki, kd, feedforward, FIRMWARE_GAINS.max_speed, FIRMWARE_GAINS.max_acceleration)
    try:
        visit.session.send(Stop())
        await visit.require(gains)
    except DriverError:
        person.tell("The board did not take its wheel control back: switch it off and on before you drive.")
