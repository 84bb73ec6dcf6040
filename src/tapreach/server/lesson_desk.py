"""Lessons for the sessions: starts one, shows what is asked, passes answers on."""

from dataclasses import asdict
from pathlib import Path

from tapreach.errors import InputError
from tapreach.robot.interface import Robot
from tapreach.robot.teachable import Teachable
from tapreach.server.hub import Hub
from tapreach.server.messages_lesson import NO_LESSON, LessonName, LessonView
from tapreach.server.page_person import Asked, PagePerson
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.task import TaskState
from tapreach.tasks.teaching.lesson import Lesson
from tapreach.tasks.teaching.task import LessonTask

LESSONS: tuple[LessonName, ...] = ("motors", "encoders", "servos")
_KEY = "lesson"


class LessonDesk:
    """One lesson at a time. robot_file: None where the running robot has none that could be written."""

    def __init__(self, hub: Hub, runner: TaskRunner, robot: Robot, robot_file: Path | None) -> None:
        self._hub, self._runner, self._robot, self._robot_file = hub, runner, robot, robot_file
        self._lesson: LessonName | None = None
        self._person: PagePerson | None = None
        self._owner_id: int | None = None

    @property
    def offered(self) -> tuple[LessonName, ...]:
        """What this robot can be taught, in the order in which that is best done."""
        robot = self._robot
        can_be = self._robot_file is not None and isinstance(robot, Teachable) and robot.can_be_taught
        return LESSONS if can_be else ()

    def start(self, lesson: LessonName, owner_id: int) -> None:
        """Begin a lesson. Raises InputError where it cannot be held, or while a task runs."""
        if self._robot_file is None or not self.offered:
            raise InputError("this robot cannot be taught: it has no board with Tapreach's firmware")
        person = PagePerson(self._show)
        self._runner.start(LessonTask(Lesson(lesson), person, self._robot_file), owner_id)
        self._lesson, self._person, self._owner_id = lesson, person, owner_id
        self._show(person.asked)

    def answer(self, question_id: int, answer: str, session_id: int) -> None:
        """Pass on an answer. Raises InputError where nothing is asked, or somebody else is."""
        if self._person is None or self._owner_id != session_id:
            raise InputError("no lesson asks you anything")
        self._person.answer(question_id, answer)

    def end(self, name: str) -> None:
        """Stop the lesson; one that has ended is put away. Raises InputError where there is none."""
        if self._lesson is None:
            raise InputError("there is no lesson")
        if self._person is not None:
            self._runner.cancel(f"stopped by {name}; nothing was written")
            return
        self._lesson = None
        self._hub.tell(_KEY, NO_LESSON)

    def task_changed(self, progress: TaskProgress) -> None:
        """Say how the lesson ended."""
        if progress.kind != LessonTask.kind or self._person is None:
            return
        if progress.state is not TaskState.RUNNING:
            said, self._person = self._person.last_words, None
            end = progress.state.value
            view = LessonView(lesson=self._lesson, said=said, ended=end, outcome=progress.message)
            self._hub.tell(_KEY, view)

    def _show(self, asked: Asked) -> None:
        self._hub.tell(_KEY, LessonView(lesson=self._lesson, **asdict(asked)))
