"""Hours of work without a fault, and the wraps of the board's clocks: nothing counts wrong, nothing trips."""

import math
import random
from dataclasses import dataclass, field
from itertools import pairwise

from tapreach.bench.figure import Figure, at_most, exactly
from tapreach.bench.firmware_bed import BedHost, firmware_host
from tapreach.bench.firmware_vanish import LIMIT_MS, silence, stop_ms
from tapreach.bench.report import Section
from tapreach.drivers.arduino import wire

WRAP_US = 2**32
ROUND_US = 60_000_000.0
TELEMETRY_US = 1_000_000 // wire.TELEMETRY_HZ
JITTER_US = 2_000
"""What may come between a period's due time and its telemetry: a frame that is just being taken."""
SETTLING_US = 300_000.0
BRAKING_US = 1_500_000.0
WRAPS_IN_US = 1_500_000.0
"""After power-on."""
BUSY_WITH = "drive", "move", "loss"


@dataclass
class Endured:
    """What was counted; all but the two times has to be 0, and the jitter small."""

    simulated_us: float = 0.0
    telemetries: int = 0
    late_or_lost: int = 0
    faulty: int = 0
    restarts: int = 0
    tick_errors: int = 0
    refusals: int = 0
    drift_us: float = 0.0
    _last_us: int | None = field(default=None, repr=False)

    def take(self, host: BedHost) -> None:
        """Count what the board told since; its periods must follow each other without a gap."""
        told = [each.message for each in host.heard if isinstance(each.message, wire.Telemetry)]
        host.heard.clear()
        times = [each.at_us for each in told]
        if self._last_us is not None:
            times.insert(0, self._last_us)
        steps = [(after - before) % WRAP_US for before, after in pairwise(times)]
        self.telemetries += len(told)
        self.late_or_lost += sum(abs(step - TELEMETRY_US) > JITTER_US for step in steps)
        self.faulty += sum(bool(each.faults) for each in told)
        self._last_us = times[-1] if times else None

    def starts(self, host: BedHost) -> None:
        """From here on: another board, or the same after something else."""
        host.heard.clear()
        self._last_us = None


def work(host: BedHost, chance: random.Random, endured: Endured, round_us: float = ROUND_US) -> None:
    """A minute, or `round_us`, of a robot's life: drives, a move, servos, and standing; ends at rest."""
    began_us, boot_id = host.rover.now_us, host.open().boot_id
    offset_us = host.offset_us
    endured.refusals += host.drive(0, 0) is not wire.Result.OK
    for _ in range(chance.randrange(1, 5)):
        host.drive_for(chance.randrange(-1500, 1500), chance.randrange(-1500, 1500), chance.uniform(5e5, 3e6))
    host.drive_for(0, 0, BRAKING_US)
    ways = chance.randrange(-2000, 2000), chance.randrange(-2000, 2000)
    endured.refusals += host.move(*ways, speed=900).result is not wire.MoveResult.DONE
    base, shoulder, elbow, claw = (chance.randrange(1000, 2000) for _ in range(wire.SERVO_COUNT))
    host.send(wire.Servos((base, shoulder, elbow, claw), (500, 500, 500, 500)))
    while host.rover.now_us - began_us < round_us:
        endured.refusals += host.drive(0, 0) is not wire.Result.OK
        host.run(900_000.0)
    _look(host, endured, boot_id, offset_us)
    endured.simulated_us += host.rover.now_us - began_us


def _look(host: BedHost, endured: Endured, boot_id: int, offset_us: float) -> None:
    host.run(SETTLING_US)
    told = host.telemetry()
    wrong = (abs(a - b) for a, b in zip((told.left, told.right), host.rover.ticks, strict=True))
    endured.tick_errors += sum(wrong)
    endured.restarts += host.open().boot_id != boot_id
    endured.drift_us = max(endured.drift_us, abs(math.remainder(host.offset_us - offset_us, WRAP_US)))
    endured.take(host)


@dataclass
class Wraps:
    """What happened when the board's clocks passed their end."""

    power_ms: list[float] = field(default_factory=list)
    moves_failed: int = 0
    passed: int = 0
    """Starts whose clock has really begun anew."""
    endured: Endured = field(default_factory=Endured)


def over_the_wrap(board: str, busy_with: str, chance: random.Random, found: Wraps) -> None:
    """Start the board shortly before its clocks wrap; the wrap falls into a "drive", a "move" or a "loss"."""
    lead_us = chance.uniform(0.1e6, 0.9e6)
    with firmware_host(board, wraps_in_us=WRAPS_IN_US) as host:
        boot_id, offset_us = host.open().boot_id, host.offset_us
        found.endured.starts(host)
        while (left_us := WRAPS_IN_US - lead_us - host.rover.now_us) > 0:
            host.drive(0, 0)
            host.run(min(left_us, 100_000.0))
        if busy_with == "drive":
            host.drive_for(chance.randrange(300, 1500), -900, 1e6)
        elif busy_with == "move":
            found.moves_failed += host.move(900, -900, speed=600).result is not wire.MoveResult.DONE
        vanish_us = WRAPS_IN_US - host.rover.now_us - chance.uniform(0.0, wire.DEADMAN_MS * 1000)
        found.power_ms.append(stop_ms(host, silence, chance, max(vanish_us, 200_000.0)))
        _look(host, found.endured, boot_id, offset_us)
        found.passed += host.telemetry().at_us < WRAP_US // 2


def measure_endurance(board: str, hours: float, wraps: int, seed: int) -> Section:
    """Work for `hours` of simulated time, and start `wraps` times before the end of the board's clocks."""
    chance, endured, found = random.Random(seed), Endured(), Wraps()
    with firmware_host(board) as host:
        endured.starts(host)
        while (left_us := hours * 3.6e9 - endured.simulated_us) > 0:
            work(host, chance, endured, min(ROUND_US, left_us))
    for index in range(wraps):
        over_the_wrap(board, BUSY_WITH[index % len(BUSY_WITH)], chance, found)
    both = (endured, found.endured)
    counted = f"{endured.simulated_us / WRAP_US:.1f} times round the count of microseconds"
    return Section(
        f"Hours of work, {board}",
        "Each minute drives, a move, servos, standing. Then the board is started anew shortly before its "
        "counts of microseconds (every 71.6 minutes) and milliseconds (every 49.7 days) wrap, both at once, "
        "and drives, moves and loses its host around that moment.",
        (
            Figure("simulated time", endured.simulated_us / 3.6e9, "h", None, counted),
            Figure("wraps passed", found.passed, "", exactly(wraps)),
            Figure("telemetry late or lost", sum(e.late_or_lost for e in both), "", exactly(0), _of(both)),
            Figure("telemetry with a fault", sum(e.faulty for e in both), "", exactly(0)),
            Figure("restarts", sum(e.restarts for e in both), "", exactly(0)),
            Figure("ticks told wrong", sum(e.tick_errors for e in both), "", exactly(0)),
            Figure("commands refused", sum(e.refusals for e in both), "", exactly(0)),
            Figure("moves that failed at a wrap", found.moves_failed, "", exactly(0)),
            Figure("clock over a minute", max(e.drift_us for e in both), "µs", at_most(JITTER_US)),
            Figure("longest power at a wrap", max(found.power_ms, default=0.0), "ms", at_most(LIMIT_MS)),
        ),
    )


def _of(both: tuple[Endured, Endured]) -> str:
    return f"of {sum(each.telemetries for each in both)}"
