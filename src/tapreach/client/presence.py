"""Shows the server that the script is there: without it the robot stops within 200 ms."""

import contextlib
from collections.abc import AsyncIterator
from typing import Any

from tapreach.client.control_link import ControlLink
from tapreach.robot.clock import MS

BEAT_NS = 50 * MS
BEATS_TO_PING = 20
"""A ping a second tells the server how fast the link can be."""


class Presence:
    """Heartbeats at 20 Hz while `attended`, from the very event loop that the script runs in.

    A loop that hangs sends none, and none is made up for afterwards.
    """

    def __init__(self, link: ControlLink) -> None:
        self._link = link
        self._attending = 0

    async def attend(self) -> None:
        """Be there from now on; returns when the server knows. Raises LinkLost, RequestRefused."""
        self._attending += 1
        await self._link.ask("heartbeat", **self._timed())

    def leave(self) -> None:
        """Take back one `attend`."""
        self._attending -= 1

    @contextlib.asynccontextmanager
    async def attended(self) -> AsyncIterator[None]:
        """Be there while the block runs."""
        try:
            await self.attend()
            yield
        finally:
            self.leave()

    async def beat(self) -> None:
        """Send what is due until cancelled. Raises LinkLost."""
        clock, beats = self._link.clock, 0
        due_ns = clock.now_ns()
        while True:
            if beats % BEATS_TO_PING == 0:
                await self._link.tell("ping", client_ms=clock.now_ns() / MS)
            elif self._attending:
                await self._link.tell("heartbeat", **self._timed())
            beats += 1
            due_ns += BEAT_NS
            if clock.now_ns() > due_ns:
                due_ns = clock.now_ns() + BEAT_NS
            await clock.sleep_until(due_ns)

    def _timed(self) -> dict[str, Any]:
        return {"client_ms": self._link.clock.now_ns() / MS, "frame_id": None}
