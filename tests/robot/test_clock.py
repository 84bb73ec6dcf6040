"""The clock that tests turn: sleepers wake in order, each at its own time."""

import asyncio
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from tapreach.robot.clock import MS, SECOND, ManualClock, MonotonicClock


@given(st.lists(st.integers(0, 1000), max_size=20), st.lists(st.integers(0, 500), max_size=8))
def test_each_sleeper_wakes_at_its_own_time_and_in_order(durations_ms, turns_ms):
    async def scenario():
        clock = ManualClock()
        start_ns, woken = clock.now_ns(), []

        async def sleep(duration_ns):
            await clock.sleep_until(start_ns + duration_ns)
            woken.append((duration_ns, clock.now_ns() - start_ns))

        sleepers = [asyncio.create_task(sleep(duration * MS)) for duration in durations_ms]
        for turn in turns_ms:
            await clock.advance(turn * MS)
        passed = sum(turns_ms) * MS
        assert clock.now_ns() == start_ns + passed
        if turns_ms:
            assert sorted(due for due, _ in woken) == sorted(d * MS for d in durations_ms if d * MS <= passed)
        assert all(now_ns == due or due == 0 for due, now_ns in woken)
        assert [due for due, _ in woken] == sorted(due for due, _ in woken)
        for sleeper in sleepers:
            sleeper.cancel()
        await asyncio.gather(*sleepers, return_exceptions=True)

    asyncio.run(scenario())


def test_periodic_sleeper_is_woken_once_per_period():
    async def scenario():
        clock = ManualClock()
        times = []

        async def tick():
            while True:
                times.append(clock.now_ns())
                await clock.sleep_until(clock.now_ns() + 20 * MS)

        task = asyncio.create_task(tick())
        await clock.advance(SECOND)
        task.cancel()
        assert len(times) == 51
        assert {later - earlier for earlier, later in pairwise(times)} == {20 * MS}

    asyncio.run(scenario())


def test_turn_moves_the_time_and_wakes_nobody():
    async def scenario():
        clock = ManualClock()
        sleeper = asyncio.create_task(clock.sleep_until(clock.now_ns() + MS))
        await asyncio.sleep(0)
        clock.turn(SECOND)
        await asyncio.sleep(0)
        assert not sleeper.done()
        await clock.advance(0)
        assert sleeper.done()

    asyncio.run(scenario())


def test_machines_clock_goes_forward_and_does_not_wait_for_the_past():
    async def scenario():
        clock = MonotonicClock()
        before = clock.now_ns()
        await asyncio.wait_for(clock.sleep_until(before - SECOND), 10)
        await clock.sleep_until(before + 5 * MS)
        assert clock.now_ns() >= before + 5 * MS
        assert clock.wall_time().tzinfo is not None

    asyncio.run(scenario())
