"""A fetch that goes on: its phases one by one as they come, and how it ended."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from enum import StrEnum

from tapreach.client.control_link import ControlLink, Message
from tapreach.client.news import FetchNews
from tapreach.client.task_watch import TaskWatch
from tapreach.errors import TapreachError


class FetchStatus(StrEnum):
    """How a fetch ended."""

    HELD = "held"
    """It is lifted, and was seen to be in the claw."""
    PLANNED = "planned"
    """It can be fetched, or may be; no more was asked."""
    REFUSED = "refused"
    """It cannot be fetched, and was not tried."""
    FAILED = "failed"
    """It was tried in vain, or the thing was not found."""
    STOPPED = "stopped"
    """Somebody or something stopped it: the robot stands."""


@dataclass(frozen=True, slots=True)
class FetchResult:
    """How it ended and why; `last` is the phase in which it did, with its plan and what can be done next."""

    status: FetchStatus
    reason: str
    last: FetchNews | None

    @property
    def is_held(self) -> bool:
        """Whether the thing is in the claw."""
        return self.status is FetchStatus.HELD


class Fetching(AsyncIterator[FetchNews]):
    """Iterate over its phases until it ends, or await `result`, or both. Raises LinkLost.

    Phases that pass faster than they are taken may be missing: the newest is always told. Leaving the
    iteration does not stop the robot; `RemoteRobot.stop` does, and so does leaving `connect`.
    """

    def __init__(self, link: ControlLink) -> None:
        self._link = link
        self._watch = TaskWatch(is_fetch=True)
        self._unsubscribe = link.subscribe(self._hear)

    async def request(self, kind: str, **fields: object) -> "Fetching":
        """Ask the server to begin. Raises RequestRefused with the reason, LinkLost."""
        try:
            await self._link.ask(kind, on_answer=self._watch.begin, **fields)
        except (TapreachError, asyncio.CancelledError):
            self._unsubscribe()
            raise
        return self

    async def __anext__(self) -> FetchNews:
        await self._link.until(lambda: self._watch.phases or self._watch.is_told)
        if not self._watch.phases:
            raise StopAsyncIteration
        return self._watch.phases.popleft()

    async def result(self) -> FetchResult:
        """Return how it ended, as soon as it has."""
        await self._link.until(lambda: self._watch.is_told)
        return _result(self._watch)

    async def confirm(self) -> None:
        """Agree with the plan, when a phase says `may_confirm`. Raises RequestRefused."""
        await self._link.ask("fetch_confirm")

    def _hear(self, message: Message) -> None:
        self._watch.hear(message)
        if self._watch.is_told:
            self._unsubscribe()


def _result(watch: TaskWatch) -> FetchResult:
    task, last = watch.result(), watch.newest_phase
    if task.status == "cancelled":
        return FetchResult(FetchStatus.STOPPED, task.reason, last)
    if task.status == "failed" or last is None or last.phase not in set(FetchStatus):
        return FetchResult(FetchStatus.FAILED, task.reason, last)
    return FetchResult(FetchStatus(last.phase), last.why or task.reason, last)
