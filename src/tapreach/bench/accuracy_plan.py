"""How much of the accuracy bench is run, and its one source of randomness."""

from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

import numpy as np


class Part(IntEnum):
    """The parts of the bench, each with random numbers of its own."""

    CELLS = 0
    SLIPS = 1
    ODD_TAPS = 2
    MOTIONS = 3
    PEERS = 4


@dataclass(frozen=True)
class AccuracyPlan:
    """trials: in each setting. motions: random ones, a fifth of them singular. comparisons: trials in each
    setting of the table beside the peers. jobs: processes. plot: file of the picture, None for none.
    """

    seed: int
    trials: int = 400
    motions: int = 4000
    comparisons: int = 100
    jobs: int = 1
    is_smoke: bool = False
    plot: Path | None = None


def smoke_plan(seed: int) -> AccuracyPlan:
    """A plan that only shows that everything works."""
    return AccuracyPlan(seed, trials=2, motions=24, comparisons=1, is_smoke=True)


def generator(seed: int, part: Part, task: int) -> np.random.Generator:
    """Return the random numbers of one task: independent of the others and of the order they run in."""
    return np.random.default_rng([seed, int(part), task])
