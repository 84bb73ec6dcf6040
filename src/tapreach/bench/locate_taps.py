"""All the taps of a run over one or more processes, each kept as soon as it is done."""

import asyncio
import multiprocessing
import os
from collections.abc import AsyncIterator
from concurrent.futures import ProcessPoolExecutor

from tapreach.bench.locate_kept import keep, read_kept
from tapreach.bench.locate_outcome import Outcome
from tapreach.bench.locate_plan import LocatePlan
from tapreach.bench.locate_run import run_tap
from tapreach.robot.clock import SECOND, Clock, MonotonicClock

_TAPS_PER_PROCESS = 12
"""A process is replaced after so many: what drawing leaves behind in it goes with it."""
_ONE_THREAD = "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"
"""Small matrices are slower on many threads, much slower where each process wants them."""


async def run_taps(plan: LocatePlan, clock: Clock) -> list[Outcome]:
    """Return the outcomes of every tap that was done in time, in their order."""
    done = read_kept(plan.kept) if plan.kept is not None else {}
    left = [number for number in range(plan.taps) if number not in done]
    until_ns = clock.now_ns() + round(plan.minutes * 60 * SECOND)
    results = (
        _in_turn(plan, left, clock, until_ns) if plan.jobs == 1 else _spread(plan, left, clock, until_ns)
    )
    async for outcomes in results:
        done[outcomes[0].tap] = outcomes
        if plan.kept is not None:
            keep(plan.kept, outcomes)
    return [outcome for number in sorted(done) for outcome in done[number] if number < plan.taps]


async def _in_turn(
    plan: LocatePlan, numbers: list[int], clock: Clock, until_ns: int
) -> AsyncIterator[list[Outcome]]:
    for number in numbers:
        if clock.now_ns() < until_ns:
            yield await run_tap(plan, number, clock)


async def _spread(
    plan: LocatePlan, numbers: list[int], clock: Clock, until_ns: int
) -> AsyncIterator[list[Outcome]]:
    for name in _ONE_THREAD:
        os.environ.setdefault(name, "1")
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(plan.jobs, spawn, max_tasks_per_child=_TAPS_PER_PROCESS) as pool:
        loop = asyncio.get_running_loop()
        running: set[asyncio.Future[list[Outcome]]] = set()
        left = list(reversed(numbers))
        while running or left:
            while left and len(running) < plan.jobs:
                running.add(loop.run_in_executor(pool, _in_process, plan, left.pop()))
            finished, running = await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)
            for future in finished:
                yield future.result()
            if clock.now_ns() >= until_ns:
                left.clear()


def _in_process(plan: LocatePlan, number: int) -> list[Outcome]:
    return asyncio.run(run_tap(plan, number, MonotonicClock()))
