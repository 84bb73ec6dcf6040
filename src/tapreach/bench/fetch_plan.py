"""How much of the bench of fetching is run, and its one source of randomness."""

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

SMOKE_RATE_HZ, SMOKE_S = 10.0, 6.0


class Chapter(StrEnum):
    """What may be run alone."""

    DEFAULT = "default"
    HARD = "hard"
    REFUSALS = "refusals"
    STOPS = "stops"
    CLUTTER = "clutter"


class Arm(StrEnum):
    """What is done about the same tap."""

    FULL = "the whole of it"
    WITHOUT_BACKGROUND = "no background"
    WITHOUT_RENEWING = "no estimating on the way"
    FIXED_MOVE = "fixed move"


@dataclass(frozen=True)
class FetchBenchPlan:
    """scenes: of the chapters with default and with hard faults; refusals, stops, clutter: of those chapters.
    comparisons: so many of the default scenes are also run in the other `arms`. jobs: processes. minutes: no
    run is begun later than this. rate_hz: pictures a second. longest_s: simulated, then a fetch is ended.

    chapter: the only one to run, None for all. kept: file of the runs that are done, continued when it
    exists. failures: picture of what went wrong; both None for none.
    """

    seed: int
    scenes: int = 100
    refusals: int = 60
    stops: int = 200
    clutter: int = 60
    comparisons: int = 40
    arms: tuple[Arm, ...] = tuple(Arm)
    jobs: int = 1
    minutes: float = 600.0
    rate_hz: float = 30.0
    longest_s: float = 200.0
    is_smoke: bool = False
    chapter: Chapter | None = None
    kept: Path | None = None
    failures: Path | None = None

    @property
    def chapters(self) -> tuple[Chapter, ...]:
        """What is run."""
        return tuple(Chapter) if self.chapter is None else (self.chapter,)

    def runs_of(self, chapter: Chapter) -> int:
        """How many different runs a chapter has."""
        return {
            Chapter.DEFAULT: self.scenes,
            Chapter.HARD: self.scenes,
            Chapter.REFUSALS: self.refusals,
            Chapter.STOPS: self.stops,
            Chapter.CLUTTER: self.clutter,
        }[chapter]

    def arms_of(self, chapter: Chapter, number: int) -> tuple[Arm, ...]:
        """What is done about one tap of a chapter; arms are set beside each other with default faults."""
        is_compared = chapter is Chapter.DEFAULT and number < self.comparisons
        return self.arms if is_compared else self.arms[:1]

    @property
    def folder(self) -> Path | None:
        """Where the picture of each run that went wrong is put."""
        return self.failures.with_suffix("") if self.failures is not None else None


def smoke_plan(
    seed: int, chapter: Chapter | None = None, kept: Path | None = None, failures: Path | None = None
) -> FetchBenchPlan:
    """A plan that only shows that everything works: one run of one chapter, ended early."""
    return FetchBenchPlan(
        seed,
        scenes=1,
        refusals=1,
        stops=1,
        clutter=1,
        rate_hz=SMOKE_RATE_HZ,
        longest_s=SMOKE_S,
        is_smoke=True,
        chapter=chapter or Chapter.DEFAULT,
        kept=kept,
        failures=failures,
    )


def generator(seed: int, chapter: Chapter, number: int, purpose: int = 0) -> np.random.Generator:
    """Return the random numbers of one run: independent of the others and of the order they run in."""
    return np.random.default_rng([seed, list(Chapter).index(chapter), number, purpose])
