"""One task at a time; the wheels stop before the task is cancelled; every end is told with a sentence."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import cast

import pytest

from tapreach.control.pilot import MotionInterrupted
from tapreach.errors import InputError
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.task import TaskContext, TaskReport, TaskState
from tasks.rig import bare_context


@dataclass
class Scripted:
    """A task that does what the test says."""

    body: Callable[[TaskContext], Awaitable[str]]
    kind: str = "scripted"

    async def run(self, context: TaskContext) -> str:
        return await self.body(context)


@dataclass
class Motion:
    """Writes down what the runner asks of the wheels."""

    calls: list[str] = field(default_factory=list)

    def admit_task(self, owner_id: int) -> None:
        self.calls.append(f"admit {owner_id}")

    def dismiss_task(self) -> None:
        self.calls.append("dismiss")

    def stop(self, reason: str) -> None:
        self.calls.append(f"stop: {reason}")


def runner_and_notes() -> tuple[TaskRunner, Motion, list[TaskProgress]]:
    motion, told = Motion(), cast(list[TaskProgress], [])
    return TaskRunner(bare_context(), motion, told.append), motion, told


async def forever(context: TaskContext) -> str:
    await asyncio.Event().wait()
    return "never"


def test_done_task_is_told_with_its_sentence() -> None:
    async def body(context: TaskContext) -> str:
        context.report(TaskReport("move", 0.4, "turning"))
        return "0.83 m away"

    async def run() -> None:
        runner, motion, told = runner_and_notes()
        assert runner.start(Scripted(body), owner=7) == 1
        await runner.wait()
        assert [(p.state, p.message) for p in told[-2:]] == [
            (TaskState.RUNNING, "turning"),
            (TaskState.DONE, "0.83 m away"),
        ]
        assert motion.calls == ["admit 7", "dismiss"]
        assert not runner.is_running
        assert runner.start(Scripted(body), owner=7) == 2
        await runner.wait()

    asyncio.run(run())


def test_cancel_stops_the_wheels_first() -> None:
    async def run() -> None:
        runner, motion, told = runner_and_notes()

        async def body(context: TaskContext) -> str:
            try:
                return await forever(context)
            finally:
                motion.calls.append("cancelled")

        runner.start(Scripted(body), owner=1)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert runner.cancel("stop button")
        assert runner.cancel("again"), "a second press does no harm"
        await runner.wait()
        assert motion.calls == ["admit 1", "stop: stop button", "cancelled", "dismiss"]
        assert (told[-1].state, told[-1].message) == (TaskState.CANCELLED, "stop button")
        assert not runner.cancel("nothing runs")

    asyncio.run(run())


def test_cancel_before_the_first_step_still_ends_the_task() -> None:
    async def run() -> None:
        runner, _, told = runner_and_notes()
        runner.start(Scripted(forever), owner=1)
        runner.cancel("at once")
        await runner.wait()
        assert told[-1].state is TaskState.CANCELLED

    asyncio.run(run())


def test_own_errors_are_told_and_strange_ones_logged(caplog: pytest.LogCaptureFixture) -> None:
    async def interrupted(context: TaskContext) -> str:
        raise MotionInterrupted("the wheels do not turn the base")

    async def broken(context: TaskContext) -> str:
        raise ZeroDivisionError("secret detail")

    async def run() -> None:
        runner, _, told = runner_and_notes()
        runner.start(Scripted(interrupted), owner=1)
        await runner.wait()
        assert (told[-1].state, told[-1].message) == (TaskState.FAILED, "the wheels do not turn the base")
        assert not caplog.records
        runner.start(Scripted(broken), owner=1)
        await runner.wait()
        assert told[-1].state is TaskState.FAILED
        assert "error of the program" in told[-1].message and "secret" not in told[-1].message
        assert caplog.records and caplog.records[0].exc_info is not None

    asyncio.run(run())


def test_second_task_is_refused_while_one_runs() -> None:
    async def run() -> None:
        runner, _, _ = runner_and_notes()
        runner.start(Scripted(forever), owner=1)
        with pytest.raises(InputError, match="still running"):
            runner.start(Scripted(forever, "guide"), owner=1)
        await runner.close()
        assert not runner.is_running

    asyncio.run(run())
