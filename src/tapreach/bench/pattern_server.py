"""The real server around the pattern robot, as a process of its own.

To its parent it tells its port, then lists of the twists that reached the wheels, each [time, linear,
angular]. From its parent it hears `compute on` and `compute off`: whether its compute process is kept busy;
after `off` it tells how many estimates were made. It ends with its stdin.
"""

import argparse
import asyncio
import contextlib
import os
import signal
import tempfile
from collections.abc import Callable
from pathlib import Path

from tapreach.bench.child import stdin_lines, tell_parent
from tapreach.bench.estimate_load import keep_estimating
from tapreach.bench.pattern import pattern_jpegs
from tapreach.bench.pattern_description import pattern_description
from tapreach.bench.pattern_robot import PatternRobot, SentTwist
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, Clock, MonotonicClock
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, run_event_loop, serve
from tapreach.server.station import Station
from tapreach.tasks.compute import ComputeProcess

TELL_PERIOD_NS = 50 * MS


class TwistLog:
    """Twists on their way to the parent: in lots, so that writing does not disturb what is measured."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._waiting: list[tuple[int, float, float]] = []

    def add(self, sent: SentTwist) -> None:
        """Note a twist."""
        self._waiting.append((sent.sent_ns, sent.twist.linear, sent.twist.angular))

    async def keep_telling(self) -> None:
        """Tell what has come in, twenty times a second, until cancelled."""
        while True:
            if self._waiting:
                tell_parent(self._waiting)
                self._waiting = []
            await self._clock.sleep_until(self._clock.now_ns() + TELL_PERIOD_NS)


class Load:
    """Work for the server's own compute process, while the parent wants it."""

    def __init__(self, keep_busy: Callable[[Callable[[], None]], "asyncio.Task[None]"]) -> None:
        self._keep_busy = keep_busy
        self._working: asyncio.Task[None] | None = None
        self._estimates = 0

    async def obey(self) -> None:
        """Follow the parent's words until it closes the pipe; an error of the work is raised here."""
        try:
            async for line in stdin_lines():
                if line == "compute on" and self._working is None:
                    self._working = self._keep_busy(self._count)
                elif line == "compute off":
                    await self._rest()
                    tell_parent({"estimates": self._estimates})
        finally:
            await self._rest()

    def _count(self) -> None:
        self._estimates += 1

    async def _rest(self) -> None:
        working, self._working = self._working, None
        if working is not None:
            working.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await working


async def _run(size: ImageSize, rate_hz: float, seed: int, captures: Path) -> None:
    clock = MonotonicClock()
    description, jpegs = pattern_description(size, rate_hz), pattern_jpegs(size, seed)
    log, compute = TwistLog(clock), ComputeProcess()
    station = Station(PatternRobot(description, jpegs, clock, log.add), clock, captures, compute)
    listener = listening_socket("127.0.0.1", 0)
    port = listener.getsockname()[1]
    load = Load(lambda count: asyncio.create_task(keep_estimating(compute, description, jpegs, seed, count)))
    telling = asyncio.create_task(log.keep_telling())
    parent = asyncio.create_task(load.obey())
    # The server ends as it always does: on a signal.
    parent.add_done_callback(lambda _: os.kill(os.getpid(), signal.SIGTERM))
    try:
        await serve(station, listener, AccessPolicy(), on_ready=lambda: tell_parent({"port": port}))
    finally:
        telling.cancel()
        parent.cancel()
    if parent.done():
        parent.result()


def main() -> None:
    """Serve until stdin closes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("width", type=int)
    parser.add_argument("height", type=int)
    parser.add_argument("rate_hz", type=float)
    parser.add_argument("seed", type=int)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tapreach-bench-") as captures:
        run_event_loop(_run(ImageSize(given.width, given.height), given.rate_hz, given.seed, Path(captures)))


if __name__ == "__main__":
    main()
