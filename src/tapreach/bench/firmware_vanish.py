"""The host vanishes while the wheels turn: how long they keep their power."""

import random
from collections.abc import Callable

from tapreach.bench.figure import Figure, at_most, exactly
from tapreach.bench.firmware_bed import BedHost, firmware_host
from tapreach.bench.report import Section
from tapreach.bench.sample import median
from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import encode
from tapreach.errors import InputError

CHARACTER_US = 1e7 / wire.BAUD
PERIOD_MS = 1000 / wire.CONTROL_HZ
LIMIT_MS = wire.DEADMAN_MS + PERIOD_MS
WATCHED_US = 400_000.0
FASTEST = 1500
"""Wheel speed [ticks/s]."""

Vanish = Callable[[BedHost, random.Random], None]


def silence(host: BedHost, chance: random.Random) -> None:
    """Say nothing more: a process that was halted."""
    host.run(WATCHED_US)


def cut(host: BedHost, chance: random.Random) -> None:
    """Break off within a frame: a cable that came out."""
    frame = encode(wire.Drive(FASTEST, FASTEST, host.at_ms), 1)
    host.rover.avr.send(frame[: chance.randrange(1, len(frame) - 1)])
    host.run(WATCHED_US)


def garbage(host: BedHost, chance: random.Random) -> None:
    """Send random bytes as fast as the line takes them: a wrong baud rate, a loose ground."""
    host.rover.avr.send(chance.randbytes(int(WATCHED_US / CHARACTER_US)))
    host.run(WATCHED_US)


def stale(host: BedHost, chance: random.Random) -> None:
    """Go on with good commands that are too old: a link that comes out of a jam."""
    for _ in range(20):
        late_ms = wire.OLDEST_MS + chance.randrange(5, 2000)
        host.send(wire.Drive(FASTEST, FASTEST, (host.at_ms - late_ms) & 0xFFFFFFFF))
        host.run(WATCHED_US / 20)


def chatter(host: BedHost, chance: random.Random) -> None:
    """Go on with pings alone: a host that is alive and has forgotten its wheels."""
    for token in range(20):
        host.send(wire.Ping(token))
        host.run(WATCHED_US / 20)


WAYS: dict[str, Vanish] = {
    "silence": silence,
    "cut in a frame": cut,
    "garbage": garbage,
    "too old commands": stale,
    "pings alone": chatter,
}


def stop_ms(host: BedHost, vanish: Vanish, chance: random.Random, driven_us: float | None = None) -> float:
    """Drive, vanish at a random moment, and return how long the power lasted after the last command [ms].

    driven_us: how long to drive before. Raises InputError when the wheels had no power before, or still have
    it in the end.
    """
    left, right = (chance.choice((-1, 1)) * chance.randrange(300, FASTEST) for _ in range(2))
    host.drive(0, 0)
    host.drive_for(left, right, driven_us or chance.uniform(150_000, 450_000))
    sent_us = host.rover.now_us
    host.send(wire.Drive(left, right, host.at_ms))
    arrived_us = sent_us + len(encode(wire.Drive(left, right, host.at_ms), 1)) * CHARACTER_US
    host.run(chance.uniform(2_000, 50_000))
    before_us = host.rover.powered_us()
    host.run(10_000)
    if host.rover.powered_us() == before_us:
        raise InputError(f"the wheels had no power at {left}, {right} ticks/s: there was nothing to stop")
    vanish(host, chance)
    off_us = host.rover.off_since_us()
    if off_us >= host.rover.now_us:
        raise InputError(f"the wheels still have power {(off_us - arrived_us) / 1000:.0f} ms later")
    return (off_us - arrived_us) / 1000


def measure_vanishing(board: str, times: int, seed: int) -> Section:
    """Vanish `times` times, in each way by turns."""
    chance = random.Random(seed)
    stops: dict[str, list[float]] = {way: [] for way in WAYS}
    with firmware_host(board) as host:
        for index in range(times):
            way = list(WAYS)[index % len(WAYS)]
            stops[way].append(stop_ms(host, WAYS[way], chance))
            host.open()
    every = [value for values in stops.values() for value in values]
    return Section(
        f"The host vanishes while the wheels turn, {board}",
        "At random moments, speeds and directions. From the arrival of the last good command to the last "
        "edge of the motors' PWM, in simulated time: to the microsecond, and the same on every machine.",
        (
            Figure("median", median(every), "ms", None, f"{len(every)} times"),
            *(Figure(f"{way}: longest", max(v), "ms", at_most(LIMIT_MS)) for way, v in stops.items() if v),
            Figure("too late", sum(value > LIMIT_MS for value in every), "", exactly(0)),
        ),
    )
