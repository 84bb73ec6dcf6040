"""The only place that asks the machine for the time. All other code is handed a Clock."""

import asyncio
import heapq
import itertools
import time
from datetime import UTC, datetime
from typing import Protocol

MS = 1_000_000
SECOND = 1_000_000_000


def processor_ns() -> int:
    """Return the processor time that this thread has used [ns]: waiting for a busy machine does not count."""
    return time.thread_time_ns()


class Clock(Protocol):
    """Monotonic time in integer nanoseconds, and a way to wait for it."""

    def now_ns(self) -> int:
        """Return monotonic time [ns]; only differences mean anything."""
        ...

    def wall_time(self) -> datetime:
        """Return the date and time (UTC), for file names and people, never for intervals."""
        ...

    async def sleep_until(self, when_ns: int) -> None:
        """Return at or after `when_ns`; at once when it has passed."""
        ...


class MonotonicClock:
    """The machine's own clock (CLOCK_MONOTONIC: the same in every process of the machine)."""

    def now_ns(self) -> int:
        """See Clock."""
        return time.monotonic_ns()

    def wall_time(self) -> datetime:
        """See Clock."""
        return datetime.now(UTC)

    async def sleep_until(self, when_ns: int) -> None:
        """See Clock."""
        await asyncio.sleep(max(0.0, (when_ns - self.now_ns()) / SECOND))


class ManualClock:
    """A clock that a test turns forward. `advance` wakes each sleeper at its own time, in order."""

    def __init__(self, start_ns: int = SECOND, wall: datetime = datetime(2026, 1, 1, tzinfo=UTC)) -> None:
        self._now_ns = start_ns
        self._wall = wall
        self._order = itertools.count()
        self._sleepers: list[tuple[int, int, asyncio.Future[None]]] = []

    def now_ns(self) -> int:
        """See Clock."""
        return self._now_ns

    def wall_time(self) -> datetime:
        """See Clock. Stands still."""
        return self._wall

    async def sleep_until(self, when_ns: int) -> None:
        """See Clock."""
        if when_ns <= self._now_ns:
            await asyncio.sleep(0)
            return
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        heapq.heappush(self._sleepers, (when_ns, next(self._order), future))
        await future

    def turn(self, duration_ns: int) -> None:
        """Move the time without waking anybody: for code that has no sleepers."""
        self._now_ns += duration_ns

    async def advance(self, duration_ns: int) -> None:
        """Move the time forward by `duration_ns`, letting whoever wakes on the way run first."""
        end_ns = self._now_ns + duration_ns
        await _let_others_run()
        while self._sleepers and self._sleepers[0][0] <= end_ns:
            when_ns, _, future = heapq.heappop(self._sleepers)
            self._now_ns = max(self._now_ns, when_ns)
            if not future.done():
                future.set_result(None)
            await _let_others_run()
        self._now_ns = end_ns
        await _let_others_run()


async def _let_others_run(rounds: int = 8) -> None:
    # A woken task may wake another: a few rounds of the loop let such chains finish.
    for _ in range(rounds):
        await asyncio.sleep(0)
