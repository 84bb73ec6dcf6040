"""Teach-in at the terminal: the board is visited alone."""

from pathlib import Path

from tapreach.drivers.arduino.bench_visit import bench_of_visit
from tapreach.drivers.arduino.ports import OpenPort, open_port
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wiring import wiring_of
from tapreach.errors import LinkLost
from tapreach.robot.clock import Clock
from tapreach.robot.config import load_robot
from tapreach.tasks.teaching.file_changes import require_own_file
from tapreach.tasks.teaching.lesson import Lesson, conclude, find_out, link_to_teach
from tapreach.tasks.teaching.person import Person


async def teach(
    lesson: Lesson, path: Path, person: Person, clock: Clock, open_port: OpenPort = open_port
) -> bool:
    """Hold a lesson and write what came of it into the robot file.

    Returns True where all is right, False where something has to be wired otherwise or was not to be written.
    Raises InputError, ConfigError, DriverError, LinkLost and TeachingStopped; then the file is as it was.
    """
    require_own_file(path)
    description = load_robot(path)
    link = link_to_teach(description)
    async with BoardVisit(link, clock, (wiring_of(link.reversed),), open_port) as visit:
        if not await visit.opened():
            raise LinkLost(visit.reason)
        finding = await find_out(lesson, bench_of_visit(visit, description, link), person, description)
        return await conclude(finding, person, path)
