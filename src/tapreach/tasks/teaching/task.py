"""A lesson as a task: under the running robot, gated like everything else that an operator starts."""

import asyncio
from pathlib import Path

from tapreach.errors import InputError
from tapreach.robot.config import load_robot
from tapreach.robot.teachable import Teachable
from tapreach.tasks.task import TaskContext, TaskReport
from tapreach.tasks.teaching.file_changes import require_own_file
from tapreach.tasks.teaching.lesson import Lesson, conclude, find_out, link_to_teach
from tapreach.tasks.teaching.person import Person

START_AGAIN = "Start Tapreach again before you drive: it goes by the robot file as it was"


class LessonTask:
    """Hold a lesson with the person at the page and, on that person's word, write the robot file at `path`.

    The lesson goes by the file as it is now, which may be newer than what the running robot goes by.
    """

    kind = "lesson"

    def __init__(self, lesson: Lesson, person: Person, path: Path) -> None:
        require_own_file(path)
        self._lesson, self._person, self._path = lesson, person, path

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises InputError, ConfigError, DriverError, MotionInterrupted, TeachingStopped."""
        context.report(TaskReport(self._lesson.value, 0.0, "teaching, step by step"))
        description = await asyncio.to_thread(load_robot, self._path)
        link_to_teach(description)
        robot = context.robot
        if not isinstance(robot, Teachable):
            raise InputError(f"{description.name!r} cannot be taught while it runs")
        async with robot.taught(description, context.pilot.carry_out) as bench:
            finding = await find_out(self._lesson, bench, self._person, description)
        before = self._path.read_bytes()
        is_right = await conclude(finding, self._person, self._path)
        if self._path.read_bytes() != before:
            return START_AGAIN
        if finding.to_wire:
            return "wires have to be changed; nothing was written"
        return "all is right" if is_right else "nothing was written"
