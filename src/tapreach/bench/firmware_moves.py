"""Relative moves made by the firmware alone, against where the robot really got to."""

import math
import random
from dataclasses import dataclass

import numpy as np

from tapreach.bench.figure import Figure, Limit, at_most, exactly
from tapreach.bench.firmware_bed import BedHost, firmware_host
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile
from tapreach.drivers.arduino import wire

TICKS_PER_TURN = 1320
WHEEL_RADIUS = 0.033
TRACK_WIDTH = 0.169
TICKS_PER_METRE = TICKS_PER_TURN / (math.tau * WHEEL_RADIUS)
SETTLING_US = 300_000.0


@dataclass(frozen=True)
class MoveError:
    """Of one move: wheels off by [ticks], base off by [m] along the way and [rad], and how it ended."""

    ticks: tuple[int, int]
    advance: float
    turn: float
    result: wire.MoveResult

    @property
    def worst_ticks(self) -> int:
        """Of both wheels."""
        return max(abs(each) for each in self.ticks)


def wheel_ticks(turn: float, advance: float) -> tuple[int, int]:
    """Return how far left and right have to go for a turn [rad] or a way ahead [m]: one is 0."""
    across = turn * TRACK_WIDTH / 2
    return round((advance - across) * TICKS_PER_METRE), round((advance + across) * TICKS_PER_METRE)


def move_error(host: BedHost, turn: float, advance: float, speed: int) -> MoveError:
    """Make a move, wait until all is at rest, and compare. One of `turn` [rad] and `advance` [m] is 0."""
    left, right = wheel_ticks(turn, advance)
    host.drive(0, 0)
    began, start = host.rover.ticks, host.rover.plant.pose
    result = host.move(left, right, speed=speed).result
    host.run(SETTLING_US)
    ended, end = host.rover.ticks, host.rover.plant.pose
    way = math.hypot(end[0] - start[0], end[1] - start[1])
    return MoveError(
        (ended[0] - began[0] - left, ended[1] - began[1] - right),
        way - abs(advance),
        end[2] - start[2] - turn,
        result,
    )


def measure_moves(board: str, times: int, seed: int, physics: bool = False) -> Section:
    """Make `times` random moves: half turns of 5° to 180°, half ways of 3 cm to 50 cm, forwards and back."""
    chance = random.Random(seed)
    turns, advances = [], []
    with firmware_host(board, physics) as host:
        for index in range(times):
            sign, speed = chance.choice((-1, 1)), chance.randrange(300, 1500)
            if index % 2:
                advances.append(move_error(host, 0.0, sign * chance.uniform(0.03, 0.5), speed))
            else:
                turns.append(move_error(host, sign * math.radians(chance.uniform(5, 180)), 0.0, speed))
    every = turns + advances
    limit = None if physics else at_most(2.0 * wire.SETTLED_TICKS)
    return Section(
        f"Random turns and advances, {board}, {'MuJoCo rover' if physics else 'two motors on a flat floor'}",
        "Each one command; ramps and the end are the firmware's. After 0.3 s of rest, against the wheels' "
        f"true way and the base's true place. {TICKS_PER_METRE / 100:.0f} ticks are a centimetre.",
        (
            Figure("moves that did not end done", _failed(every), "", exactly(0), f"of {len(every)}"),
            Figure("wheel error: median", median([e.worst_ticks for e in every]), "ticks"),
            Figure("wheel error: largest", max(e.worst_ticks for e in every), "ticks", limit),
            *_spread("turn", [math.degrees(e.turn) for e in turns], "°", None),
            *_spread("advance", [1000 * e.advance for e in advances], "mm", None),
        ),
    )


def _failed(errors: list[MoveError]) -> int:
    return sum(error.result is not wire.MoveResult.DONE for error in errors)


def _spread(what: str, errors: list[float], unit: str, limit: Limit | None) -> tuple[Figure, ...]:
    sizes = list(np.abs(errors).tolist())
    return (
        Figure(f"{what} error: median", median(sizes), unit, None, f"{len(sizes)} of them"),
        Figure(f"{what} error: 95 %", percentile(sizes, 95), unit),
        Figure(f"{what} error: largest", max(sizes), unit, limit),
    )
