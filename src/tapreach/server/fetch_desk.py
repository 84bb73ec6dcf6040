"""Fetching for the sessions: starts it, passes on the operator's word, remembers what was stopped."""

from collections.abc import Sequence
from dataclasses import replace

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray
from tapreach.server.fetch_view import fetch_view, plan_lines_in_world
from tapreach.server.hub import Hub
from tapreach.server.messages_fetch import NOTHING_FETCHED
from tapreach.tasks.fetch.after import FollowUp
from tapreach.tasks.fetch.fetch_state import FetchState, Mode, Verb
from tapreach.tasks.fetch.states import is_end
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.target import Target
from tapreach.tasks.task import Tap, TaskState

_KEY = "fetch"


class FetchDesk:
    """One thing at a time. The page sees the newest state, also after its end."""

    def __init__(self, hub: Hub, runner: TaskRunner) -> None:
        self._hub = hub
        self._runner = runner
        self._task: FetchTask | None = None
        self._state: FetchState | None = None
        self.lines_in_world: list[FloatArray] = []
        """What is to be drawn into frames of the plan (n, 3) each [m]; none when nothing is being fetched."""

    def start(self, tap: Tap, target_id: int, mode: Mode, others: Sequence[Target], owner: int) -> None:
        """Begin to fetch what was tapped, mindful of the `others`. Raises InputError while a task runs."""
        zero = self._task.memory.zero if self._task is not None else None
        self._begin(FetchTask(tap, target_id, mode, others, zero), owner)

    def confirm(self) -> None:
        """The operator's word. Raises InputError when nothing waits for it."""
        if self._task is None or self._state is None or not self._state.may_confirm:
            raise InputError("nothing waits to be confirmed")
        self._task.confirm()

    def resume(self, others: Sequence[Target], owner: int) -> None:
        """Go on with what was stopped. Raises InputError when there is nothing to go on with."""
        if self._task is None or self._state is None or not self._state.may_resume:
            raise InputError("there is no stopped fetch to go on with: tap the thing again")
        self._begin(self._task.resumed(others), owner)

    def follow_up(self, verb: Verb, owner: int) -> None:
        """Do something with what is held. Raises InputError when that cannot be done now."""
        if self._task is None or self._state is None or verb not in self._state.verbs:
            possible = ", ".join(self._state.verbs) if self._state is not None else ""
            raise InputError(f"{verb} cannot be done now; possible: {possible or 'nothing, nothing is held'}")
        self._runner.start(FollowUp(verb, self._task.memory), owner)

    def show(self, state: FetchState | None) -> None:
        """Show a state to every page; None: nothing is being fetched or held any more."""
        self._state = state
        goes_on = state is not None and not is_end(state.phase)
        self.lines_in_world = plan_lines_in_world(state.plan) if state is not None and goes_on else []
        self._hub.tell(_KEY, fetch_view(state) if state is not None else NOTHING_FETCHED)

    def task_changed(self, progress: TaskProgress) -> None:
        """Say how the robot stands when a fetch has ended before its time."""
        ended = progress.kind == FetchTask.kind and progress.state in (TaskState.CANCELLED, TaskState.FAILED)
        if ended and self._state is not None and not is_end(self._state.phase):
            self.show(replace(self._state, stopped=progress.message or "stopped"))

    def _begin(self, task: FetchTask, owner: int) -> None:
        self._runner.start(task, owner)
        self._task, self._state = task, None
