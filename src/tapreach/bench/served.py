"""The bench's side of the pattern server: a real server in its own process, and what its wheels were told."""

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from typing import Any

from tapreach.bench.child import Child, started
from tapreach.bench.pattern_robot import SentTwist
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.messages import Twist


class Wheels:
    """Every twist that reached the driver, in order, and a way to wait for the next of a kind.

    `estimates`: how many the compute process had made when it was last told to rest.
    """

    def __init__(self) -> None:
        self.sent: list[SentTwist] = []
        self.estimates = 0
        self._changed = asyncio.Event()

    def hear(self, line: Any) -> None:
        """Take one line of the pattern server: twists, or a count of estimates."""
        if isinstance(line, dict):
            self.estimates = line["estimates"]
            return
        self.sent += [SentTwist(when_ns, Twist(linear, angular)) for when_ns, linear, angular in line]
        self._changed.set()

    async def next(
        self, is_wanted: Callable[[Twist], bool], since_ns: int, seconds: float = 15.0
    ) -> SentTwist:
        """Return the first twist of that kind sent at or after `since_ns`. TimeoutError when none comes."""
        async with asyncio.timeout(seconds):
            while True:
                self._changed.clear()
                # Backwards: what is asked for is mostly among the last few.
                recent = [sent for sent in self.sent[-500:] if sent.sent_ns >= since_ns]
                found = next((sent for sent in recent if is_wanted(sent.twist)), None)
                if found is not None:
                    return found
                await self._changed.wait()

    async def stop_after(self, since_ns: int) -> SentTwist:
        """Return the first zero sent at or after `since_ns`."""
        return await self.next(lambda twist: twist.is_zero, since_ns)

    async def moving_after(self, since_ns: int) -> SentTwist:
        """Return the first twist that moves, sent at or after `since_ns`."""
        return await self.next(lambda twist: not twist.is_zero, since_ns)


@dataclass(frozen=True)
class PatternServer:
    """A running pattern server."""

    child: Child
    size: ImageSize
    wheels: Wheels

    @property
    def port(self) -> int:
        """Its port of loopback."""
        return self.child.port

    @property
    def url(self) -> str:
        """Where the page is."""
        return f"http://localhost:{self.port}/"

    def compute(self, is_on: bool) -> None:
        """Begin or end to keep the compute process busy with estimating."""
        self.child.say("compute on" if is_on else "compute off")


@contextlib.asynccontextmanager
async def pattern_server(size: ImageSize, rate_hz: float, seed: int) -> AsyncIterator[PatternServer]:
    """Run a pattern server while the block runs."""
    wheels = Wheels()
    arguments = (size.width, size.height, rate_hz, seed)
    async with started("tapreach.bench.pattern_server", *arguments, on_line=wheels.hear) as child:
        yield PatternServer(child, size, wheels)
