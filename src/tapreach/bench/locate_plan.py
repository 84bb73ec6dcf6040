"""How much of the bench of locating is run, and its one source of randomness."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

from tapreach.drivers.sim.scene import Scene, load_scene, scene_names
from tapreach.drivers.sim.scene_random import random_scene

RANDOM_SCENES = 3
"""So many of every ten taps (seven scenes ship) are in a random scene of their own."""
SMOKE_TAPS, SMOKE_RATE_HZ = 1, 6.0


class Arm(StrEnum):
    """What is done about the same tap."""

    CHOSEN = "chosen move, background"
    WITHOUT_BACKGROUND = "chosen move, no background"
    FIXED = "fixed move"


@dataclass(frozen=True)
class LocatePlan:
    """taps: each with the first of `arms`, and the first `comparisons` of them with all. jobs: processes.
    minutes: no tap is begun later than this. rate_hz: pictures a second.

    kept: file of the taps that are done, continued when it exists; None for none. plot, failures: files of
    the pictures, None for none.
    """

    seed: int
    taps: int = 200
    comparisons: int = 60
    arms: tuple[Arm, ...] = tuple(Arm)
    jobs: int = 1
    minutes: float = 90.0
    rate_hz: float = 30.0
    is_smoke: bool = False
    kept: Path | None = None
    plot: Path | None = None
    failures: Path | None = None

    def arms_of(self, tap: int) -> tuple[Arm, ...]:
        """What is done about the tap with this number."""
        return self.arms if tap < self.comparisons else self.arms[:1]

    @property
    def folder(self) -> Path | None:
        """Where the picture of each tap that went wrong is put."""
        return self.failures.with_suffix("") if self.failures is not None else None


def smoke_plan(seed: int) -> LocatePlan:
    """A plan that only shows that everything works."""
    return LocatePlan(seed, SMOKE_TAPS, arms=(Arm.CHOSEN, Arm.FIXED), rate_hz=SMOKE_RATE_HZ, is_smoke=True)


def generator(seed: int, tap: int) -> np.random.Generator:
    """Return the random numbers of one tap: independent of the others and of the order they run in."""
    return np.random.default_rng([seed, tap])


def scene_of(seed: int, tap: int) -> tuple[str, Scene]:
    """Return the scene of a tap and its name: those that ship in turns, then random ones ('random')."""
    shipped = scene_names()
    place = tap % (len(shipped) + RANDOM_SCENES)
    if place < len(shipped):
        return shipped[place], load_scene(shipped[place])
    own_seed = int(np.random.default_rng([seed, tap, 1]).integers(1 << 31))
    return "random", random_scene(own_seed)
