"""The worker process answers, fails clearly, keeps its state, and never outlives its parent."""

import asyncio
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tapreach.errors import InputError
from tapreach.tasks.compute import ComputeDied, ComputeProcess, InlineCompute
from tapreach.tasks.compute_worker import answer_to, with_length

_memory: list[int] = []


def remember(number: int) -> list[int]:
    _memory.append(number)
    return list(_memory)


def refuse(word: str) -> None:
    raise InputError(f"not {word}")


def die() -> None:
    os._exit(3)


def shout() -> str:
    print("a library talks to stdout", flush=True)  # noqa: T201
    return "said"


class Awkward(Exception):
    def __init__(self, first: str, second: str) -> None:
        super().__init__(first)


def raise_awkward() -> None:
    raise Awkward("one", "two")


def is_alive(pid: int) -> bool:
    """True while the process runs; a zombie that nobody waits for does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


async def gone(pid: int) -> bool:
    for _ in range(500):
        if not is_alive(pid):
            return True
        await asyncio.sleep(0.01)
    return False


def test_results_errors_and_state() -> None:
    async def run() -> None:
        compute = ComputeProcess()
        try:
            assert await compute.call(divmod, 7, 2) == (3, 1)
            assert await compute.call(remember, 1) == [1]
            assert await compute.call(remember, 2) == [1, 2]
            with pytest.raises(InputError, match="not so"):
                await compute.call(refuse, "so")
            assert await compute.call(shout) == "said"
            both = await asyncio.gather(compute.call(divmod, 5, 3), compute.call(divmod, 9, 4))
            assert both == [(1, 2), (2, 1)]
        finally:
            await compute.close()

    asyncio.run(run())


def test_cancelled_call_does_not_disturb_the_next() -> None:
    async def run() -> None:
        compute = ComputeProcess()
        try:
            waiting = asyncio.create_task(compute.call(divmod, 7, 2))
            await asyncio.sleep(0)
            waiting.cancel()
            assert await compute.call(divmod, 9, 2) == (4, 1)
        finally:
            await compute.close()

    asyncio.run(run())


def test_dead_worker_is_an_error_once_and_then_replaced() -> None:
    async def run() -> None:
        compute = ComputeProcess()
        try:
            await compute.call(remember, 1)
            first = compute.pid
            with pytest.raises(ComputeDied, match="code 3"):
                await compute.call(die)
            assert await compute.call(remember, 5) == [5], "a new worker remembers nothing"
            assert compute.pid != first
            for _ in range(2):
                with pytest.raises(ComputeDied, match="code 3"):
                    await compute.call(die)
            with pytest.raises(ComputeDied, match="twice"):
                await compute.call(remember, 1)
        finally:
            await compute.close()

    asyncio.run(run())


def test_close_ends_the_worker_and_refuses_calls() -> None:
    async def run() -> None:
        compute = ComputeProcess()
        await compute.start()
        pid = compute.pid
        assert pid is not None and is_alive(pid)
        await compute.close()
        await compute.close()
        assert await gone(pid)
        with pytest.raises(ComputeDied, match="closed"):
            await compute.call(divmod, 1, 1)

    asyncio.run(run())


PARENT = """
import asyncio, sys
from tapreach.tasks.compute import ComputeProcess

async def main():
    compute = ComputeProcess()
    await compute.call(divmod, 1, 1)
    print(compute.pid, flush=True)
    await asyncio.sleep(60)

asyncio.run(main())
"""


def test_worker_dies_with_a_killed_parent() -> None:
    parent = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True)
    try:
        assert parent.stdout is not None
        worker = int(parent.stdout.readline())
        assert is_alive(worker)
        parent.send_signal(signal.SIGKILL)
        parent.wait(10)
        assert asyncio.run(gone(worker))
    finally:
        parent.kill()
        parent.wait(10)
        assert parent.stdout is not None
        parent.stdout.close()


def test_error_that_cannot_travel_is_told_as_text() -> None:
    import pickle

    blob = with_length((4, raise_awkward, ()))[8:]
    call_id, is_result, error = pickle.loads(answer_to(blob)[8:])
    assert (call_id, is_result) == (4, False)
    assert "Awkward: one" in str(error)


def test_inline_compute_runs_in_place() -> None:
    assert asyncio.run(InlineCompute().call(divmod, 7, 2)) == (3, 1)
