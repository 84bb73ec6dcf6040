"""A real `tapreach run`, with the simulated robot as a newcomer starts it, or with another."""

import asyncio
import contextlib
import os
import re
import signal
import sys
from collections.abc import AsyncIterator
from dataclasses import dataclass

from tapreach.bench.ending import finish
from tapreach.bench.proc import ProcessId, family, is_alive
from tapreach.bench.video_client import Viewing, view
from tapreach.errors import SetupError
from tapreach.robot.clock import SECOND, Clock

_COMMAND = ("-c", "from tapreach.cli.main import main; main()", "run", "--port", "0", "--robot")
_ADDRESS = re.compile(rb"http://[\w.]+:(\d+)/")
_START_SECONDS = 60.0
_LEAVE_SECONDS = 10.0


@dataclass(frozen=True)
class SimulatedRun:
    """A running `tapreach run`; `begun_ns` is when its process was started."""

    process: asyncio.subprocess.Process
    port: int
    begun_ns: int

    @property
    def url(self) -> str:
        """Where the page is."""
        return f"http://localhost:{self.port}/"

    @property
    def family(self) -> list[ProcessId]:
        """Its processes, the started one first."""
        return family(self.process.pid)

    async def first_picture(self, clock: Clock) -> int:
        """Return when a viewer has received its first picture [ns]."""
        viewing = Viewing()
        watching = asyncio.create_task(view(self.port, viewing, clock))
        waiting = asyncio.create_task(viewing.first.wait())
        await asyncio.wait((watching, waiting), return_when=asyncio.FIRST_COMPLETED, timeout=_START_SECONDS)
        await finish(waiting)
        await finish(watching)
        if not viewing.arrivals:
            raise SetupError("tapreach run served no picture; its own words are above")
        return viewing.arrivals[0].received_ns


@contextlib.asynccontextmanager
async def simulated_run(clock: Clock, robot: str = "sim") -> AsyncIterator[SimulatedRun]:
    """Run `tapreach run --robot ...` while the block runs; every process of it is gone afterwards."""
    begun_ns = clock.now_ns()
    words = (*_COMMAND, robot)
    process = await asyncio.create_subprocess_exec(sys.executable, *words, stdout=asyncio.subprocess.PIPE)
    members: list[ProcessId] = []
    try:
        port = await asyncio.wait_for(_announced_port(process), _START_SECONDS)
        reading = asyncio.create_task(_swallow(process))
        run = SimulatedRun(process, port, begun_ns)
        yield run
        members = run.family
    finally:
        await _end(process, members, clock)
    await reading


async def _announced_port(process: asyncio.subprocess.Process) -> int:
    assert process.stdout is not None
    async for line in process.stdout:
        found = _ADDRESS.search(line)
        if found:
            return int(found.group(1))
    raise SetupError("tapreach run ended without printing its address; its own words are above")


async def _swallow(process: asyncio.subprocess.Process) -> None:
    # What else it prints is read, so that it never waits for a full pipe.
    assert process.stdout is not None
    while await process.stdout.read(4096):
        pass


async def _end(process: asyncio.subprocess.Process, members: list[ProcessId], clock: Clock) -> None:
    if process.returncode is None:
        process.send_signal(signal.SIGTERM)
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(process.wait(), _LEAVE_SECONDS)
    if process.returncode is None:
        process.kill()
        await process.wait()
    end_ns = clock.now_ns() + SECOND
    while any(map(is_alive, members)) and clock.now_ns() < end_ns:
        await clock.sleep_until(clock.now_ns() + SECOND // 20)
    kill(members)


def kill(members: list[ProcessId]) -> int:
    """Kill those of `members` that still live and return how many they were."""
    left = [member for member in members if is_alive(member)]
    for member in left:
        with contextlib.suppress(ProcessLookupError):
            os.kill(member.pid, signal.SIGKILL)
    return len(left)
