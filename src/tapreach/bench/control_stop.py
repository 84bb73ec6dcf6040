"""How long the wheels go on after the operator has let go, fallen silent, gone away or fallen behind."""

import random
import signal
from dataclasses import dataclass, field
from typing import Any

from tapreach.bench.child import Child, started
from tapreach.bench.control_client import ControlClient
from tapreach.bench.control_latency import watching_operator
from tapreach.bench.figure import Figure, Limit, at_most, exactly
from tapreach.bench.report import Section
from tapreach.bench.sample import median
from tapreach.bench.served import PatternServer
from tapreach.bench.video_client import Viewing
from tapreach.robot.clock import MS, Clock
from tapreach.robot.messages import Twist

SPEED = 0.2
AT_ONCE_MS = 20.0
"""One period of the control loop: what counts as at once."""
SILENCE_MS = 240.0
"""200 ms of silence, and two periods of the control loop: one is lost waiting, one may be late."""
LATE_MS = 1000.0
"""How old the stale drive messages are."""
STALE_FOR_NS = 500 * MS


@dataclass
class DriveLog:
    """What a drive client has told of its messages."""

    sent_ns: list[int] = field(default_factory=list)

    def hear(self, line: dict[str, Any]) -> None:
        """Take one line of the client."""
        self.sent_ns.append(line["sent_ns"])


async def measure_stops(server: PatternServer, times: int, seed: int, clock: Clock) -> Section:
    """Stop `times` times in each of four ways."""
    chance = random.Random(seed)
    released = [await _release(server, chance, clock) for _ in range(times)]
    closed = [await _closed(server, chance, clock) for _ in range(times)]
    silent = [await _silence(server, chance, clock) for _ in range(times)]
    stale, executed = await _stale(server, times, clock)
    return Section(
        "From the operator's end to zero at the wheels",
        "Release: a stop message. Closed: the operator's process is killed. Silence: it is halted (SIGSTOP), "
        "its sockets stay open; counted from its last message. Stale: drive messages that are a second old; "
        "counted from the last fresh one.",
        (
            *_figures("release", released, at_most(AT_ONCE_MS)),
            *_figures("closed", closed, at_most(AT_ONCE_MS)),
            *_figures("silence", silent, at_most(SILENCE_MS)),
            *_figures("stale input", stale, at_most(SILENCE_MS)),
            Figure("stale input: commands obeyed", executed, "", exactly(0)),
        ),
    )


def _figures(what: str, times_ms: list[float], limit: Limit) -> tuple[Figure, ...]:
    return (
        Figure(f"{what}: median", median(times_ms), "ms", None, f"{len(times_ms)} times"),
        Figure(f"{what}: longest", max(times_ms), "ms", limit),
    )


async def _drive_for(
    client: ControlClient, viewing: Viewing, duration_ns: int, clock: Clock, late_ms: float = 0.0
) -> int:
    """Drive at 20 Hz; return when the last message left [ns]."""
    end_ns = clock.now_ns() + duration_ns
    while True:
        answer = await client.drive(Twist(SPEED, 0.0), viewing.arrivals[-1].frame_id, late_ms)
        if answer.sent_ns + 50 * MS > end_ns:
            return answer.sent_ns
        await clock.sleep_until(answer.sent_ns + 50 * MS)


async def _release(server: PatternServer, chance: random.Random, clock: Clock) -> float:
    async with watching_operator(server.port, clock) as (client, viewing):
        await _drive_for(client, viewing, chance.randint(150, 300) * MS, clock)
        await clock.sleep_until(clock.now_ns() + chance.randint(0, 50) * MS)
        answer = await client.ask("stop", reason="release")
        stop = await server.wheels.stop_after(answer.sent_ns)
        return (stop.sent_ns - answer.sent_ns) / MS


async def _driving_child(server: PatternServer, child: Child, chance: random.Random, clock: Clock) -> None:
    begin_ns = clock.now_ns()
    await server.wheels.moving_after(begin_ns)
    await clock.sleep_until(begin_ns + chance.randint(150, 300) * MS)


async def _closed(server: PatternServer, chance: random.Random, clock: Clock) -> float:
    async with started("tapreach.bench.drive_client", server.port, SPEED) as child:
        await _driving_child(server, child, chance, clock)
        killed_ns = clock.now_ns()
        child.signal(signal.SIGKILL)
        stop = await server.wheels.stop_after(killed_ns)
        return (stop.sent_ns - killed_ns) / MS


async def _silence(server: PatternServer, chance: random.Random, clock: Clock) -> float:
    log = DriveLog()
    async with started("tapreach.bench.drive_client", server.port, SPEED, on_line=log.hear) as child:
        await _driving_child(server, child, chance, clock)
        child.signal(signal.SIGSTOP)
        halted_ns = clock.now_ns()
        stop = await server.wheels.stop_after(halted_ns)
        child.signal(signal.SIGKILL)
        return (stop.sent_ns - log.sent_ns[-1]) / MS


async def _stale(server: PatternServer, times: int, clock: Clock) -> tuple[list[float], int]:
    """Return the times to zero [ms], and how many twists moved the wheels after that."""
    stops_ms: list[float] = []
    executed = 0
    for _ in range(times):
        async with watching_operator(server.port, clock) as (client, viewing):
            fresh_ns = await _drive_for(client, viewing, 200 * MS, clock)
            await _drive_for(client, viewing, STALE_FOR_NS, clock, LATE_MS)
            stop = await server.wheels.stop_after(fresh_ns)
            stops_ms.append((stop.sent_ns - fresh_ns) / MS)
            executed += sum(s.sent_ns > stop.sent_ns and not s.twist.is_zero for s in server.wheels.sent)
    return stops_ms, executed
