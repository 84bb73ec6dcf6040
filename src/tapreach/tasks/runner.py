"""Runs one task at a time, tells everybody how it goes, and stops it at once."""

import asyncio
import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from tapreach.errors import InputError, TapreachError
from tapreach.tasks.task import Task, TaskContext, TaskReport, TaskState

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class TaskProgress:
    """The running or last task, as the page shows it. owner: the session that started it."""

    task_id: int
    kind: str
    owner: int
    state: TaskState
    phase: str
    progress: float
    message: str


class MotionRights(Protocol):
    """Who lets a task move the robot, and takes that back; the control loop is one."""

    def admit_task(self, owner_id: int) -> None:
        """Let a task of this session move the robot, as long as the session may."""
        ...

    def dismiss_task(self) -> None:
        """The task has ended: nothing it asked for may go on."""
        ...

    def stop(self, reason: str) -> object:
        """Zero speed now."""
        ...


class TaskRunner:
    """Starts tasks and cancels them. At most one runs.

    context: what tasks may touch; its `report` is replaced by the runner's own. motion: asked to stop the
    wheels before a task is cancelled. on_progress: hears every change.
    """

    def __init__(
        self,
        context: TaskContext,
        motion: MotionRights,
        on_progress: Callable[[TaskProgress], None],
    ) -> None:
        self._context = context
        self._motion = motion
        self._on_progress = on_progress
        self._progress: TaskProgress | None = None
        self._work: asyncio.Task[str] | None = None
        self._running: asyncio.Task[None] | None = None
        self._cancel_reason = ""

    @property
    def progress(self) -> TaskProgress | None:
        """The running or last task, None before the first."""
        return self._progress

    @property
    def is_running(self) -> bool:
        """True from `start` until the task has ended."""
        return self._running is not None and not self._running.done()

    def start(self, task: Task, owner: int) -> int:
        """Start `task` for the session `owner` and return its id. Raises InputError while another
        one runs.
        """
        if self.is_running and self._progress is not None:
            raise InputError(
                f"'{self._progress.kind}' is still running; stop it before starting '{task.kind}'"
            )
        task_id = self._progress.task_id + 1 if self._progress is not None else 1
        self._cancel_reason = ""
        self._motion.admit_task(owner)
        self._tell(TaskProgress(task_id, task.kind, owner, TaskState.RUNNING, "start", 0.0, ""))
        work = asyncio.create_task(
            _started(task, replace(self._context, report=self._report)), name=task.kind
        )
        self._work, self._running = work, asyncio.create_task(self._supervise(task.kind, work))
        return task_id

    def cancel(self, reason: str) -> bool:
        """Stop the wheels and then the running task; False when none runs. Returns before the
        task has ended.
        """
        if not self.is_running or self._work is None:
            return False
        if not self._cancel_reason:
            self._cancel_reason = reason
            self._motion.stop(reason)
            self._work.cancel()
        return True

    async def wait(self) -> None:
        """Return when no task runs."""
        if self._running is not None:
            await asyncio.wait({self._running})

    async def close(self) -> None:
        """Cancel what runs and wait for its end."""
        self.cancel("the server is closing")
        await self.wait()

    async def _supervise(self, kind: str, work: asyncio.Task[str]) -> None:
        await asyncio.wait({work})
        self._motion.dismiss_task()
        self._end(*self._outcome(kind, work))

    def _outcome(self, kind: str, work: asyncio.Task[str]) -> tuple[TaskState, str]:
        if work.cancelled():
            return TaskState.CANCELLED, self._cancel_reason or "stopped"
        error = work.exception()
        if error is None:
            return TaskState.DONE, work.result()
        if isinstance(error, TapreachError):
            return TaskState.FAILED, str(error)
        _log.error("task '%s' failed unexpectedly", kind, exc_info=error)
        return TaskState.FAILED, f"'{kind}' met an error of the program; the log has the details"

    def _report(self, report: TaskReport) -> None:
        if self._progress is not None and self._progress.state is TaskState.RUNNING:
            progress = min(1.0, max(0.0, report.progress))
            self._tell(replace(self._progress, phase=report.phase, progress=progress, message=report.message))

    def _end(self, state: TaskState, message: str) -> None:
        assert self._progress is not None
        progress = 1.0 if state is TaskState.DONE else self._progress.progress
        self._tell(replace(self._progress, state=state, progress=progress, message=message))

    def _tell(self, progress: TaskProgress) -> None:
        self._progress = progress
        self._on_progress(progress)


async def _started(task: Task, context: TaskContext) -> str:
    return await task.run(context)
