"""A lesson from the first question to the written robot file, whoever is asked and whatever moves."""

from enum import StrEnum
from pathlib import Path

from tapreach.errors import InputError
from tapreach.robot.config import RobotDescription
from tapreach.robot.link_section import LinkSection
from tapreach.robot.teachable import Bench
from tapreach.tasks.teaching.encoders import count_encoders
from tapreach.tasks.teaching.finding import Finding
from tapreach.tasks.teaching.motors import try_motors
from tapreach.tasks.teaching.offer import offer_changes
from tapreach.tasks.teaching.person import Person
from tapreach.tasks.teaching.servos import teach_servos


class Lesson(StrEnum):
    """What can be taught."""

    SERVOS = "servos"
    MOTORS = "motors"
    ENCODERS = "encoders"


def link_to_teach(description: RobotDescription) -> LinkSection:
    """Return the link to a board that can be taught. Raises InputError where there is none."""
    if description.link is None or description.link.protocol != "tapreach":
        raise InputError(f"{description.name!r} has no board with Tapreach's firmware: nothing to teach")
    return description.link


async def find_out(lesson: Lesson, bench: Bench, person: Person, description: RobotDescription) -> Finding:
    """Hold the lesson; `description` is the robot file as it is now.

    Raises InputError, DriverError, TeachingStopped, and what carries moves out.
    """
    if lesson is Lesson.MOTORS:
        return await try_motors(bench, person, link_to_teach(description).reversed)
    if lesson is Lesson.SERVOS:
        return await teach_servos(bench, person)
    return await count_encoders(bench, person)


async def conclude(finding: Finding, person: Person, path: Path) -> bool:
    """Say what came of it, and write it on the person's word.

    Returns True where all is right, False where something has to be wired otherwise or was not to be written.
    Raises ConfigError, TeachingStopped; then the file is as it was.
    """
    if finding.to_wire:
        person.tell("Switch it off, then:")
        for fault in finding.to_wire:
            person.tell(f"  - {fault}")
        person.tell("and test again.")
        return False
    if finding.words:
        person.tell(finding.words)
    if not finding.changes:
        return True
    is_written = await offer_changes(person, path, finding.changes)
    after = finding.if_written if is_written else finding.if_not
    if after:
        person.tell(after)
    return is_written
