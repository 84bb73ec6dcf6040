"""Teach-in from the first question to the written robot file."""

from enum import StrEnum
from pathlib import Path

from tapreach.cli.teaching.encoders import count_encoders
from tapreach.cli.teaching.file_changes import require_own_file
from tapreach.cli.teaching.motors import MotorFindings, try_motors
from tapreach.cli.teaching.offer import offer_changes
from tapreach.cli.teaching.person import Person
from tapreach.cli.teaching.servos import teach_servos
from tapreach.drivers.arduino.ports import OpenPort, open_port
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wiring import wiring_of
from tapreach.errors import InputError, LinkLost
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.link_section import LinkSection


class Lesson(StrEnum):
    """What can be taught."""

    SERVOS = "servos"
    MOTORS = "motors"
    ENCODERS = "encoders"


async def teach(
    lesson: Lesson, path: Path, person: Person, clock: Clock, open_port: OpenPort = open_port
) -> bool:
    """Hold a lesson and write what came of it into the robot file.

    Returns True where all is right, False where something has to be wired otherwise. Raises InputError,
    ConfigError, DriverError, LinkLost and TeachingStopped; then the file is as it was.
    """
    require_own_file(path)
    description = load_robot(path)
    link = _own_link(description)
    async with BoardVisit(link, clock, (wiring_of(link.reversed),), open_port) as visit:
        if not await visit.opened():
            raise LinkLost(visit.reason)
        if lesson is Lesson.MOTORS:
            findings = await try_motors(visit, person, link)
            return await _take_findings(person, path, link, findings)
        if lesson is Lesson.SERVOS:
            changes = await teach_servos(visit, person, description.arm)
        else:
            changes = await count_encoders(visit, person)
        await offer_changes(person, path, changes)
    return True


def _own_link(description: RobotDescription) -> LinkSection:
    if description.link is None or description.link.protocol != "tapreach":
        raise InputError(f"{description.name!r} has no board with Tapreach's firmware: nothing to teach")
    return description.link


async def _take_findings(person: Person, path: Path, link: LinkSection, findings: MotorFindings) -> bool:
    if findings.to_wire:
        person.tell("\nSwitch it off, then:")
        for fault in findings.to_wire:
            person.tell(f"  - {fault}")
        person.tell("and test again.")
        return False
    if set(findings.reversed) == set(link.reversed):
        person.tell("\nMotors and encoders are right.")
        return True
    person.tell("\nThe board can make up for what is the other way round:")
    is_written = await offer_changes(person, path, {("link", "reversed"): list(findings.reversed)})
    person.tell("Test again: all is right then." if is_written else "Swap wires then, and test again.")
    return is_written
