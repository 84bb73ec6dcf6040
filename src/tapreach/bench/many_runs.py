"""Many simulated runs over one or more processes, each told of as soon as it is done."""

import asyncio
import multiprocessing
import os
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import TypeVar

from tapreach.robot.clock import SECOND, Clock, MonotonicClock
from tapreach.tasks.compute_worker import die_with_parent

Result = TypeVar("Result")
Run = Callable[[int, Clock], Awaitable[Result]]
"""Does the run with this number; the clock is for what it takes. Must pickle for more than one process."""

_RUNS_PER_PROCESS = 12
"""A process is replaced after so many: what drawing leaves behind in it goes with it."""
_ONE_THREAD = "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"
"""Small matrices are slower on many threads, much slower where each process wants them."""


@dataclass(frozen=True)
class Budget:
    """Over how many processes runs are spread, and until when one may be begun [ns of the clock]."""

    jobs: int
    until_ns: int

    @classmethod
    def of(cls, jobs: int, minutes: float, clock: Clock) -> "Budget":
        """Return the budget of so many minutes from now."""
        return cls(jobs, clock.now_ns() + round(minutes * 60 * SECOND))


async def many_runs(
    run: Run[Result], numbers: Sequence[int], budget: Budget, clock: Clock
) -> AsyncIterator[Result]:
    """Do the runs with these numbers, begun in this order, as far as the time allows."""
    results = _in_turn if budget.jobs == 1 else _spread
    async for result in results(run, numbers, budget, clock):
        yield result


async def _in_turn(
    run: Run[Result], numbers: Sequence[int], budget: Budget, clock: Clock
) -> AsyncIterator[Result]:
    for number in numbers:
        if clock.now_ns() < budget.until_ns:
            yield await run(number, clock)


async def _spread(
    run: Run[Result], numbers: Sequence[int], budget: Budget, clock: Clock
) -> AsyncIterator[Result]:
    for name in _ONE_THREAD:
        os.environ.setdefault(name, "1")
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(
        budget.jobs, spawn, initializer=die_with_parent, max_tasks_per_child=_RUNS_PER_PROCESS
    ) as pool:
        loop = asyncio.get_running_loop()
        running: set[asyncio.Future[Result]] = set()
        left = list(reversed(numbers))
        while running or left:
            while left and len(running) < budget.jobs:
                running.add(loop.run_in_executor(pool, _in_process, run, left.pop()))
            finished, running = await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)
            for future in finished:
                yield future.result()
            if clock.now_ns() >= budget.until_ns:
                left.clear()


def _in_process(run: Run[Result], number: int) -> Result:
    return asyncio.run(_run(run, number))


async def _run(run: Run[Result], number: int) -> Result:
    return await run(number, MonotonicClock())
