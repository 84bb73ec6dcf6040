"""A planned approach as a value: legs to the last look, the last stretch, the stand."""

import math
from dataclasses import dataclass, replace
from itertools import accumulate

from tapreach.control.relative_move import slowed
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import BaseSection
from tapreach.tasks.fetch.durations import step_seconds
from tapreach.tasks.fetch.stand import Stance

NEAR_SHARE = 0.5
"""Share of a task's usual speed on the last stretch."""


@dataclass(frozen=True)
class Leg:
    """A turn on the spot and an advance, at `share` of a task's usual speed.

    sees_thing: the thing's middle is in the picture from the end of the turn to the end of the advance.
    """

    step: PlanarStep
    share: float
    sees_thing: bool

    def seconds(self, base: BaseSection) -> float:
        """Return how long it takes [s]."""
        return step_seconds(self.step, slowed(base, self.share))


@dataclass(frozen=True)
class Approach:
    """The way from `start` to a stand before a thing. Poses are world_from_base.

    legs: to the last look. is_whole_at_last_look: all of the thing is in the picture there. last_stretch:
    from there straight to the stand. stance: how the base stands before it and the arm grips. seen_at_stand:
    from which to which height its front is still in the picture at the stand [m]; None for nothing of it.
    side: direction of the claw at the stand against the line of sight across which the width is known [rad,
    left]. blind_cov (2, 2): what the last stretch adds to the error of the thing's place, along and across
    the claw [m²]. round_what: name of what is driven around, '' for nothing. seconds: of driving [s].
    """

    start: PlanarPose
    legs: tuple[Leg, ...]
    is_whole_at_last_look: bool
    last_stretch: Leg
    stance: Stance
    seen_at_stand: tuple[float, float] | None
    side: float
    blind_cov: FloatArray
    round_what: str
    seconds: float

    @property
    def path(self) -> tuple[PlanarPose, ...]:
        """Where the base is at the start and after each leg; the last is the stand."""
        steps = [leg.step for leg in (*self.legs, self.last_stretch)]
        return tuple(accumulate(steps, PlanarPose.after, initial=self.start))

    @property
    def last_look(self) -> PlanarPose:
        """Where it is looked at for the last time."""
        return self.path[-2]

    @property
    def stand(self) -> PlanarPose:
        """Where it is gripped from."""
        return self.path[-1]

    def seen_from_world(self, world_from_here: PlanarPose) -> "Approach":
        """Return the same way with its start given in the world, where `start` was given in `here`."""
        return replace(self, start=world_from_here.compose(self.start))

    def in_words(self) -> str:
        """Such as 'turning 12° left, 0.80 m forward; last look 0.10 m before the stand'."""
        parts = [words for leg in self.legs for words in _in_words(leg.step)]
        stretch = f"last look {self.last_stretch.step.advance:.2f} m before the stand"
        around = f"round {self.round_what}: " if self.round_what else ""
        return f"{around}{', '.join(parts) or 'from here'}; {stretch}"


@dataclass(frozen=True)
class NoWay:
    """Why no way leads to a stand, and what would help."""

    reason: str
    advice: str


def _in_words(step: PlanarStep) -> list[str]:
    words = []
    if abs(step.turn) > math.radians(2.0):
        words.append(f"turning {abs(math.degrees(step.turn)):.0f}° {'left' if step.turn > 0.0 else 'right'}")
    if abs(step.advance) > 0.005:
        words.append(f"{abs(step.advance):.2f} m {'forward' if step.advance > 0.0 else 'back'}")
    return words
