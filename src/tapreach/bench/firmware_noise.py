"""Random bytes and damaged frames: nothing moves, nothing restarts, and the next good frame is understood."""

import random
from dataclasses import dataclass

from tapreach.bench.figure import Figure, exactly
from tapreach.bench.firmware_bed import BedHost, firmware_host
from tapreach.bench.report import Section
from tapreach.drivers.arduino import wire
from tapreach.drivers.arduino.frame_reader import FrameReader, encode

CHARACTER_US = 1e7 / wire.BAUD
BURST = 1000
"""Bytes between two looks."""
ANSWER_US = 20_000.0


def good_frame(chance: random.Random, at_ms: int) -> bytes:
    """Return a frame that would move the wheels or the servos, or undo a limit."""
    speed = chance.randrange(200, 1500)
    message = chance.choice(
        (
            wire.Drive(speed, -speed, at_ms),
            wire.Drive(0, 0, at_ms),
            wire.Move(1, speed, speed, speed, 1000, at_ms),
            wire.Keep(at_ms),
            wire.Servos((1500, 1200, 1700, 1500), (500, 500, 500, 500)),
            wire.Clear(wire.Fault(0x7F)),
        )
    )
    return encode(message, chance.randrange(256))


def damaged(frame: bytes, chance: random.Random) -> bytes:
    """Return the frame with one to three bits flipped, bytes lost, added or swapped, or its end cut off."""
    content = bytearray(frame[1:-1])
    at = chance.randrange(len(content))
    kind = chance.randrange(5)
    if kind == 0:
        for _ in range(chance.randrange(1, 4)):
            content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    elif kind == 1:
        del content[at : at + chance.randrange(1, 4)]
    elif kind == 2:
        content[at:at] = chance.randbytes(chance.randrange(1, 80))
    elif kind == 3:
        content[at], content[at - 1] = content[at - 1], content[at]
    else:
        del content[at:]
    return b"\0" + bytes(content) + b"\0"


def burst(chance: random.Random, at_ms: int, size: int = BURST) -> bytes:
    """Return about `size` bytes of noise: none of its frames is a good one."""
    while True:
        noise = bytearray()
        while len(noise) < size:
            is_damaged = chance.random() < 0.7
            noise += damaged(good_frame(chance, at_ms), chance) if is_damaged else chance.randbytes(20)
        # What damage left whole (equal bytes swapped, a flip undone), or fits by chance, is not noise.
        if not FrameReader().feed(b"\0" + bytes(noise) + b"\0"):
            return bytes(noise)


def send_burst(host: BedHost, noise: bytes) -> bool:
    """Send noise to wheels that are ready, and a ping behind it; tell whether that was answered at once.

    Nothing ends the noise: the ping's own first zero is what the firmware has to find.
    """
    host.drive(0, 0)
    host.rover.avr.send(noise)
    host.run(len(noise) * CHARACTER_US)
    token = len(noise)
    host.send(wire.Ping(token))
    heard = host.run(ANSWER_US)
    return any(isinstance(each.message, wire.Pong) and each.message.token == token for each in heard)


@dataclass(frozen=True)
class NoiseEffect:
    """What noise did: bytes sent, pings not answered of how many, and what must all be 0."""

    sent: int
    unanswered: int
    pings: int
    powered_us: float
    ticks: int
    restarts: int
    servos: int


def noise_effect(host: BedHost, size: int, chance: random.Random) -> NoiseEffect:
    """Send `size` bytes of noise."""
    before, powered_us, ticks = host.open(), host.rover.powered_us(), host.rover.ticks
    sent = pings = unanswered = 0
    while sent < size:
        noise = burst(chance, host.at_ms)
        sent += len(noise)
        pings += 1
        unanswered += not send_burst(host, noise)
    told, after = host.telemetry(), host.open()
    moved = sum(abs(now - then) for now, then in zip(host.rover.ticks, ticks, strict=True))
    powered_us = host.rover.powered_us() - powered_us
    has_restarted = after.boot_id != before.boot_id
    return NoiseEffect(
        sent, unanswered, pings, powered_us, moved, int(has_restarted), sum(map(bool, told.pulse_us))
    )


def measure_noise(board: str, size: int, seed: int) -> Section:
    """Send `size` bytes of noise to a fresh robot."""
    with firmware_host(board) as host:
        effect = noise_effect(host, size, random.Random(seed))
    return Section(
        f"Noise on the line, {board}",
        "Random bytes and good frames with bits flipped, bytes lost, added, swapped, or the end cut off, at "
        f"the full rate of the line, the wheels ready to move; after each {BURST} bytes one good frame.",
        (
            Figure("bytes sent", effect.sent),
            Figure("time that a motor had power", effect.powered_us / 1000, "ms", exactly(0)),
            Figure("ticks", effect.ticks, "", exactly(0)),
            Figure("restarts", effect.restarts, "", exactly(0)),
            Figure("servos that were moved", effect.servos, "", exactly(0)),
            Figure("good frames not answered", effect.unanswered, "", exactly(0), f"of {effect.pings}"),
        ),
    )
