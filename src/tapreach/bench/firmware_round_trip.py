"""How long a question to the firmware takes, telemetry going on beside it."""

import random

from tapreach.bench.figure import Figure, at_most
from tapreach.bench.firmware_bed import firmware_host
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile


def measure_round_trip(board: str, times: int, seed: int) -> Section:
    """Ping `times` times at random moments, the wheels standing."""
    chance = random.Random(seed)
    with firmware_host(board) as host:
        trips_ms = []
        for _ in range(times):
            host.run(chance.uniform(1_000, 30_000))
            trips_ms.append(host.round_trip_us() / 1000)
    return Section(
        f"Round trip on the line, {board}",
        "From the first bit of a ping to the last of its pong at 115200 baud, in simulated time; telemetry "
        "of 50 Hz may be in the way. 2.3 ms of it are the bits themselves.",
        (
            Figure("median", median(trips_ms), "ms", None, f"{times} times"),
            Figure("95 %", percentile(trips_ms, 95), "ms"),
            Figure("longest", max(trips_ms), "ms", at_most(20.0)),
        ),
    )
