"""The real server around the pattern robot, as a process of its own.

To its parent it tells its port, then every twist that reaches the wheels as [time, linear, angular]. From its
parent it hears `compute on` and `compute off`: whether its compute process is kept busy; after `off` it tells
how many estimates were made. It ends with its stdin.
"""

import argparse
import asyncio
import os
import signal
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tapreach.bench.child import stdin_lines, tell_parent
from tapreach.bench.estimate_load import keep_estimating
from tapreach.bench.pattern import pattern_jpegs
from tapreach.bench.pattern_robot import PatternRobot, SentTwist, pattern_description
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import RobotDescription
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, serve
from tapreach.server.station import Station
from tapreach.tasks.compute import ComputeProcess


class Load:
    """A compute process like the server's own, kept busy while it is told to be."""

    def __init__(self, description: RobotDescription, jpegs: Sequence[bytes], seed: int) -> None:
        self._description = description
        self._jpegs = jpegs
        self._seed = seed
        self._compute = ComputeProcess()
        self._working: asyncio.Task[None] | None = None
        self._estimates = 0

    async def obey(self) -> None:
        """Follow the parent's words until it closes the pipe."""
        await self._compute.start()
        async for line in stdin_lines():
            if line == "compute on" and self._working is None:
                work = keep_estimating(self._compute, self._description, self._jpegs, self._seed, self._count)
                self._working = asyncio.create_task(work)
            elif line == "compute off":
                await self.rest()
                tell_parent({"estimates": self._estimates})

    def _count(self) -> None:
        self._estimates += 1

    async def rest(self) -> None:
        """End the work that runs; an error of it is raised here."""
        working, self._working = self._working, None
        if working is None:
            return
        if working.done():
            working.result()
        working.cancel()
        await asyncio.gather(working, return_exceptions=True)

    async def close(self) -> None:
        """End the process."""
        await self.rest()
        await self._compute.close()


async def _run(size: ImageSize, rate_hz: float, seed: int, captures: Path) -> None:
    clock = MonotonicClock()
    description, jpegs = pattern_description(size, rate_hz), pattern_jpegs(size, seed)
    station = Station(PatternRobot(description, jpegs, clock, _tell_twist), clock, captures)
    load = Load(description, jpegs, seed)
    listener = listening_socket("127.0.0.1", 0)
    port = listener.getsockname()[1]
    parent = asyncio.create_task(load.obey())
    # The server ends as it always does: on a signal.
    parent.add_done_callback(lambda _: os.kill(os.getpid(), signal.SIGTERM))
    try:
        await serve(station, listener, AccessPolicy(), on_ready=lambda: tell_parent({"port": port}))
        if parent.done():
            parent.result()  # an error of the load is the bench's error: the process ends with it
    finally:
        parent.cancel()
        await load.close()


def _tell_twist(sent: SentTwist) -> None:
    tell_parent([sent.sent_ns, sent.twist.linear, sent.twist.angular])


def main() -> None:
    """Serve until stdin closes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("width", type=int)
    parser.add_argument("height", type=int)
    parser.add_argument("rate_hz", type=float)
    parser.add_argument("seed", type=int)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tapreach-bench-") as captures:
        asyncio.run(_run(ImageSize(given.width, given.height), given.rate_hz, given.seed, Path(captures)))


if __name__ == "__main__":
    main()
