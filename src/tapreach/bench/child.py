"""A process of the bench's own: started, listened to line by line, ended with the bench."""

import asyncio
import contextlib
import json
import sys
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

from tapreach.errors import SetupError

_START_SECONDS = 60.0
_END_SECONDS = 5.0


class Child:
    """A running child. Its stdout is JSON, one value a line; the first line says that it is ready."""

    def __init__(self, process: asyncio.subprocess.Process, on_line: Callable[[Any], None]) -> None:
        self._process = process
        self._on_line = on_line
        self._reading: asyncio.Task[None] | None = None
        self.ready: dict[str, Any] = {}

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    @property
    def port(self) -> int:
        """The port of loopback it said to listen on."""
        return int(self.ready["port"])

    def say(self, line: str) -> None:
        """Write a line to its stdin."""
        assert self._process.stdin is not None
        self._process.stdin.write(line.encode() + b"\n")

    def signal(self, number: int) -> None:
        """Send it a signal."""
        self._process.send_signal(number)

    async def begin(self) -> None:
        """Wait for the first line, then pass on the others. Raises SetupError when it does not come."""
        assert self._process.stdout is not None
        try:
            line = await asyncio.wait_for(self._process.stdout.readline(), _START_SECONDS)
        except TimeoutError as error:
            raise SetupError(f"a process of the bench was not ready after {_START_SECONDS:g} s") from error
        if not line:
            raise SetupError("a process of the bench ended before it was ready; its own words are above")
        self.ready = json.loads(line)
        self._reading = asyncio.create_task(self._read())

    async def _read(self) -> None:
        assert self._process.stdout is not None
        async for line in self._process.stdout:
            self._on_line(json.loads(line))

    async def end(self) -> None:
        """Close its stdin, on which it ends by itself; kill it when it does not."""
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            await asyncio.wait_for(self._process.wait(), _END_SECONDS)
        except TimeoutError:
            self._process.kill()
            await self._process.wait()
        if self._reading is not None:
            await self._reading


@contextlib.asynccontextmanager
async def started(
    module: str, *arguments: object, on_line: Callable[[Any], None] = lambda _: None
) -> AsyncIterator[Child]:
    """Run `python -m module arguments...` while the block runs; yields it once it is ready."""
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        module,
        *map(str, arguments),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        cwd=Path.cwd(),
    )
    child = Child(process, on_line)
    try:
        await child.begin()
        yield child
    finally:
        await child.end()


async def stdin_lines() -> AsyncIterator[str]:
    """In the child: the lines its parent says, until the parent closes the pipe or is gone."""
    reader = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin.buffer
    )
    async for line in reader:
        yield line.decode().strip()


def tell_parent(value: object) -> None:
    """In the child: one JSON line to the parent, at once."""
    sys.stdout.write(json.dumps(value) + "\n")
    sys.stdout.flush()
