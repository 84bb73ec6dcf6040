"""Where heavy functions run: in a worker process beside the control loop, or in place.

A solve of 400 ms in the server's own process would hold up every command for as long; in another process it
does not.
"""

import asyncio
import importlib
import itertools
import os
import pickle
import sys
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable
from typing import TypeVar

from tapreach.errors import TapreachError
from tapreach.tasks.compute_worker import LENGTH, with_length

T = TypeVar("T")

_WARM_MODULES = ("tapreach.tasks.following", "tapreach.tasks.online")

# On a small machine the other cores belong to the control loop and the camera.
_ONE_THREAD = {"OPENCV_FOR_THREADS_NUM": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


class ComputeDied(TapreachError):
    """The worker process ended while it was needed. What it remembered (followed places) is gone."""


class InlineCompute:
    """Runs functions where they are called: for tests, commands and small programs."""

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        """See tasks.task.Compute. Gives others a turn first, as the worker process would."""
        await asyncio.sleep(0)
        return function(*arguments)

    async def start(self) -> None:
        """Nothing to start."""

    async def close(self) -> None:
        """Nothing to close."""


class ComputeProcess:
    """Runs functions, one after the other, in one worker process that never outlives this one.

    `start` opens it and warms its imports; `close` ends it. When the worker dies the calls that wait raise
    ComputeDied, and the next call starts another one; a worker that dies twice without an answer in between
    is given up.
    """

    def __init__(self) -> None:
        self._process: Process | None = None
        self._reader: asyncio.Task[None] | None = None
        self._waiting: dict[int, asyncio.Future[object]] = {}
        self._ids = itertools.count(1)
        self._starting = asyncio.Lock()
        self._deaths = 0
        self._is_closed = False

    @property
    def pid(self) -> int | None:
        """The worker's process id, None while there is none."""
        return self._process.pid if self._process is not None else None

    async def start(self) -> None:
        """Start the worker and wait until it has imported what it will need."""
        await self.call(import_modules, _WARM_MODULES)

    async def close(self) -> None:
        """End the worker. Calls that still wait raise ComputeDied. Safe to call twice."""
        self._is_closed = True
        process, reader = self._process, self._reader
        if process is None or reader is None:
            return
        if process.returncode is None:
            process.kill()
        await reader

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        """See tasks.task.Compute. Raises ComputeDied when the worker ends before it has answered."""
        process = await self._running()
        call_id = next(self._ids)
        answer: asyncio.Future[object] = asyncio.get_running_loop().create_future()
        self._waiting[call_id] = answer
        try:
            assert process.stdin is not None
            process.stdin.write(with_length((call_id, function, arguments)))
            return await answer  # type: ignore[return-value]
        finally:
            self._waiting.pop(call_id, None)

    async def _running(self) -> Process:
        async with self._starting:
            if self._is_closed:
                raise ComputeDied("the worker process has been closed; nothing can be computed any more")
            if self._process is None:
                if self._deaths >= 2:
                    raise ComputeDied("the worker process died twice in a row; restart tapreach")
                command = (sys.executable, "-m", "tapreach.tasks.compute_worker")
                environment = {**os.environ, **_ONE_THREAD}
                self._process = await asyncio.create_subprocess_exec(
                    *command, stdin=PIPE, stdout=PIPE, env=environment
                )
                self._reader = asyncio.create_task(self._read(self._process), name="compute answers")
            return self._process

    async def _read(self, process: Process) -> None:
        """Hand answers to those who wait, until the worker ends."""
        assert process.stdout is not None and process.stdin is not None
        try:
            while True:
                (length,) = LENGTH.unpack(await process.stdout.readexactly(LENGTH.size))
                self._hand_over(await process.stdout.readexactly(length))
        except (asyncio.IncompleteReadError, ConnectionError):
            pass
        finally:
            process.stdin.close()
            code = await process.wait()
            self._process = None
            self._deaths += 1
            self._fail_all(f"the worker process ended unexpectedly (code {code}): tap again")

    def _hand_over(self, blob: bytes) -> None:
        call_id, is_result, value = unpickled(blob)
        self._deaths = 0
        answer = self._waiting.get(call_id)
        if answer is None or answer.done():
            return
        if is_result:
            answer.set_result(value)
        else:
            assert isinstance(value, Exception)
            answer.set_exception(value)

    def _fail_all(self, reason: str) -> None:
        for answer in self._waiting.values():
            if not answer.done():
                answer.set_exception(ComputeDied(reason))


def unpickled(blob: bytes) -> tuple[int, bool, object]:
    """Return an answer of our own worker: (call id, whether it is a result, the value or the error)."""
    call_id, is_result, value = pickle.loads(blob)
    return call_id, is_result, value


def import_modules(names: tuple[str, ...]) -> None:
    """Import modules by name, so that the first call that matters does not wait for it."""
    for name in names:
        importlib.import_module(name)
