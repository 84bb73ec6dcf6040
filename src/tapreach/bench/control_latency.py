"""From a drive message to the driver, with the compute process idle and with it busy estimating."""

import asyncio
import contextlib
import itertools
import random
from collections.abc import AsyncIterator, Iterator

from tapreach.bench.control_client import Answer, ControlClient, operator
from tapreach.bench.ending import finish
from tapreach.bench.figure import Figure, at_least, at_most
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile
from tapreach.bench.served import PatternServer, Wheels
from tapreach.bench.video_client import Viewing, view
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.messages import Twist

CRUISE = 0.1
"""Speed that the drive messages ask for [m/s]."""
MARK = 1e-7
"""Each message asks for this much more than the one before, so that it is recognised at the driver [m/s]."""
RAMP_NS = SECOND
SHORTEST_GAP_MS, LONGEST_GAP_MS = 10, 40


@contextlib.asynccontextmanager
async def watching_operator(port: int, clock: Clock) -> AsyncIterator[tuple[ControlClient, Viewing]]:
    """Yield a session that holds the lease and sees the video."""
    viewing = Viewing()
    watching = asyncio.create_task(view(port, viewing, clock))
    try:
        await asyncio.wait_for(viewing.first.wait(), 30)
        async with operator(port, clock) as client:
            yield client, viewing
    finally:
        await finish(watching)


async def measure_latency(server: PatternServer, seconds: float, seed: int, clock: Clock) -> Section:
    """Drive at irregular moments in turns without and with estimating, half the time each."""
    chance = random.Random(seed)
    speeds = (CRUISE + MARK * number for number in itertools.count())
    to_driver: dict[bool, list[float]] = {False: [], True: []}
    round_trips: dict[bool, list[float]] = {False: [], True: []}
    async with watching_operator(server.port, clock) as (client, viewing):
        for is_computing in (False, True, False, True):
            if is_computing:
                server.compute(True)
            answers = await _drive(client, viewing, seconds / 4, speeds, chance, clock)
            round_trips[is_computing] += [answer.round_trip_ms for _, answer in answers]
            to_driver[is_computing] += _to_driver_ms(answers, server.wheels)
            server.compute(False)
    return Section(
        "Command round trip",
        f"Drive messages every {SHORTEST_GAP_MS} to {LONGEST_GAP_MS} ms beside the video, without and with a "
        "compute process estimating without pause, in turns. Round trip: until the answer that tells what "
        "was sent to the wheels.",
        (
            *_figures("to the driver", to_driver),
            *_figures("round trip", round_trips),
            Figure("estimates made meanwhile", server.wheels.estimates, "", at_least(1)),
        ),
    )


def _figures(what: str, series: dict[bool, list[float]]) -> tuple[Figure, ...]:
    idle, busy = series[False], series[True]
    ratio = percentile(busy, 99) / percentile(idle, 99)
    count = f"{len(busy)} commands"
    limits = (at_most(0.5), at_most(5.0), at_most(3.0)) if what == "to the driver" else (None, None, None)
    return (
        Figure(f"{what}, idle: median", median(idle), "ms", None, f"{len(idle)} commands"),
        Figure(f"{what}, idle: 99 %", percentile(idle, 99), "ms"),
        Figure(f"{what}, estimating: median", median(busy), "ms", limits[0], count),
        Figure(f"{what}, estimating: 99 %", percentile(busy, 99), "ms", limits[1]),
        Figure(f"{what}: 99 %, estimating over idle", ratio, "", limits[2]),
    )


async def _drive(
    client: ControlClient,
    viewing: Viewing,
    seconds: float,
    speeds: Iterator[float],
    chance: random.Random,
    clock: Clock,
) -> list[tuple[float, Answer]]:
    """Return (speed asked for, answer) of each message after the ramp."""
    begin_ns = clock.now_ns()
    answers: list[tuple[float, Answer]] = []
    while clock.now_ns() < begin_ns + RAMP_NS + round(seconds * SECOND):
        speed = next(speeds)
        answer = await client.drive(Twist(speed, 0.0), viewing.arrivals[-1].frame_id)
        if answer.sent_ns > begin_ns + RAMP_NS:
            answers.append((speed, answer))
        await clock.sleep_until(answer.sent_ns + chance.randint(SHORTEST_GAP_MS, LONGEST_GAP_MS) * MS)
    return answers


def _to_driver_ms(answers: list[tuple[float, Answer]], wheels: Wheels) -> list[float]:
    """From each message's sending to the first time that the driver was told its speed [ms]."""
    first_ns: dict[float, int] = {}
    for sent in wheels.sent:
        first_ns.setdefault(sent.twist.linear, sent.sent_ns)
    return [(first_ns[speed] - answer.sent_ns) / MS for speed, answer in answers if speed in first_ns]
