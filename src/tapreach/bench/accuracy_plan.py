"""How much of the accuracy bench is run, and its one source of randomness."""

from dataclasses import dataclass
from enum import IntEnum, StrEnum
from pathlib import Path

import numpy as np


class Part(IntEnum):
    """The parts of the bench, each with random numbers of its own."""

    CELLS = 0
    SLIPS = 1
    ODD_TAPS = 2
    MOTIONS = 3
    PEERS = 4
    MOVES = 5


class Chapter(StrEnum):
    """What may be run alone."""

    BESIDE = "beside"
    SETTINGS = "settings"
    MOTIONS = "motions"
    MOVES = "moves"
    SLIPS = "slips"
    ODD_TAPS = "odd-taps"


@dataclass(frozen=True)
class AccuracyPlan:
    """trials: in each setting, and up to `rounds` times as many where chance leaves a figure open. motions:
    random ones. comparisons: trials in each setting of the table beside the peers. targets: at each depth,
    for the chosen move. jobs: processes. plot: file of the picture, None for none. chapter: the only one to
    run, None for all.
    """

    seed: int
    trials: int = 250
    motions: int = 100_000
    comparisons: int = 100
    rounds: int = 20
    targets: int = 4
    jobs: int = 1
    is_smoke: bool = False
    plot: Path | None = None
    chapter: Chapter | None = None


def smoke_plan(seed: int, chapter: Chapter | None = None) -> AccuracyPlan:
    """A plan that only shows that everything works."""
    return AccuracyPlan(
        seed, trials=2, motions=24, comparisons=1, rounds=1, targets=1, is_smoke=True, chapter=chapter
    )


def generator(seed: int, part: Part, task: int) -> np.random.Generator:
    """Return the random numbers of one task: independent of the others and of the order they run in."""
    return np.random.default_rng([seed, int(part), task])
