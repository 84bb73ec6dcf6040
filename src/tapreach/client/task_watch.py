"""Follows one task from its start to its end, and keeps what was told meanwhile."""

from collections import deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Literal

from tapreach.client.control_link import ControlLink, Message
from tapreach.client.news import FetchNews, TargetNews, TaskNews
from tapreach.errors import TapreachError

_STATES_TO_SETTLE = 2
"""News of other kinds may wait behind that of a task's end, but not behind two rounds of `state`."""


@dataclass(frozen=True, slots=True)
class TaskResult:
    """How a task ended, and in words why; `target`: what was located, as it was told last."""

    status: Literal["done", "failed", "cancelled"]
    reason: str
    target: TargetNews | None = None


class TaskWatch:
    """Hears all news; counts only what comes after `begin`, which is called with the answer to the request.

    is_fetch: whether its end is told by a last phase, beside the task's own.
    """

    def __init__(self, is_fetch: bool = False) -> None:
        self._is_fetch = is_fetch
        self._has_begun = False
        self._states_since_end = 0
        self.task: TaskNews | None = None
        self.phases: deque[FetchNews] = deque()
        """What was told of fetching and has not been taken yet, oldest first."""
        self.newest_phase: FetchNews | None = None
        self.targets: dict[int, TargetNews] = {}

    def begin(self) -> None:
        """The server has taken the request: what it tells from now on is of this task."""
        self._has_begun = True

    def hear(self, message: Message) -> None:
        """Take one piece of news. Raises ValueError for what cannot be read."""
        if not self._has_begun:
            return
        if message["type"] == "task":
            self.task = TaskNews.model_validate(message)
        elif message["type"] == "fetch":
            self._take_phase(FetchNews.model_validate(message))
        elif message["type"] == "target":
            target = TargetNews.model_validate(message)
            self.targets[target.target_id] = target
        elif message["type"] == "state" and self.has_ended:
            self._states_since_end += 1

    @property
    def has_ended(self) -> bool:
        """Whether the task itself is over."""
        return self.task is not None and self.task.state != "running"

    @property
    def is_told(self) -> bool:
        """Whether it is over and nothing more will be told of it."""
        is_final = self._is_fetch and self.newest_phase is not None and self.newest_phase.is_final
        return self.has_ended and (is_final or self._states_since_end >= _STATES_TO_SETTLE)

    def result(self, frame_id: int | None = None) -> TaskResult:
        """Return how it ended. frame_id: of the tap whose target is wanted."""
        if self.task is None or self.task.state == "running":
            raise TapreachError("the task has not ended yet")
        ours = [each for each in self.targets.values() if each.frame_id == frame_id]
        target = max(ours, key=lambda each: each.target_id, default=None)
        return TaskResult(self.task.state, self.task.message, target)

    def _take_phase(self, phase: FetchNews) -> None:
        self.newest_phase = phase
        self.phases.append(phase)


@asynccontextmanager
async def watching(link: ControlLink) -> AsyncIterator[TaskWatch]:
    """Yield a watch that hears the link's news while the block runs."""
    watch = TaskWatch()
    unsubscribe = link.subscribe(watch.hear)
    try:
        yield watch
    finally:
        unsubscribe()
