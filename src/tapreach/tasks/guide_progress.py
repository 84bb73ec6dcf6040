"""Where a person is in a guided procedure: pure, each event returns the next state."""

import math
from dataclasses import dataclass, field, replace
from math import degrees, radians

from tapreach.errors import InputError
from tapreach.geometry.finite import finite
from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.tasks.guide_state import Step
from tapreach.tasks.sighting import Sighting

STRAIGHT = 0.02
"""A path counts as turn-then-advance while it ends this near to the line along the new heading [m]."""


@dataclass(frozen=True)
class GuideProgress:
    """Step number from 0, taps by step key, and values typed over the odometry's: theta [rad],
    distance [m].
    """

    table: tuple[Step, ...]
    number: int = 0
    taps: dict[str, Sighting] = field(default_factory=dict)
    typed: dict[str, float] = field(default_factory=dict)
    rough: Sighting | None = None

    @property
    def step(self) -> Step:
        """The present row of the table."""
        return self.table[self.number]

    @property
    def is_complete(self) -> bool:
        """True when every tap that is needed has been made."""
        return all(step.key in self.taps for step in self.table if step.needs_tap)

    @property
    def acts(self) -> tuple[str, ...]:
        """What may be asked for in this step."""
        own = (
            (self.step.act,)
            if self.step.act and (self.step.act != "centre" or self.rough is not None)
            else ()
        )
        can_go_on = self.number + 1 < len(self.table) and (
            not self.step.needs_tap or self.step.key in self.taps
        )
        return own + (("next",) if can_go_on else ()) + (("back",) if self.number else ())

    def tapped(self, sighting: Sighting) -> "GuideProgress":
        """Take a tap; a needed one leads on to the next step. Raises InputError where none is wanted."""
        if not self.step.wants_tap:
            raise InputError(f"step '{self.step.title}' takes no tap: {self.step.instruction}")
        if not self.step.needs_tap:
            return replace(self, rough=sighting)
        last = len(self.table) - 1
        taps = {**self.taps, self.step.key: sighting}
        return replace(self, taps=taps, number=min(self.number + 1, last), rough=None)

    def acted(self, act: str) -> "GuideProgress":
        """Go on or back. Raises InputError for what this step does not offer."""
        self.require(act)
        if act == "back":
            return self._back()
        return replace(self, number=self.number + 1, rough=None) if act == "next" else self

    def require(self, act: str) -> None:
        """Raise InputError unless `act` is on offer."""
        if act not in self.acts:
            raise InputError(
                f"'{act}' is not on offer in step '{self.step.title}'; there is: {', '.join(self.acts)}"
            )

    def with_value(self, name: str, value: float | None) -> "GuideProgress":
        """Type 'theta_deg' [degrees] or 'distance' [m], or take it back with None. Raises InputError."""
        key = {"theta_deg": "theta", "distance": "distance"}.get(name)
        if key is None:
            raise InputError(f"there is no value {name!r}; there are 'theta_deg' and 'distance'")
        kept = {each: number for each, number in self.typed.items() if each != key}
        if value is not None:
            number = finite(name, value)
            kept[key] = radians(number) if key == "theta" else number
        return replace(self, typed=kept)

    def theta(self, here: PlanarPose | None) -> float | None:
        """Return the turn [rad, left] since the first tap, typed or by odometry; None before the
        first tap.
        """
        if "theta" in self.typed:
            return self.typed["theta"]
        step = self.driven(here)
        return wrapped(step.heading) if step is not None else None

    def distance(self, here: PlanarPose | None) -> float | None:
        """Return the advance [m] along the present heading since the first tap; None before it."""
        if "distance" in self.typed:
            return self.typed["distance"]
        step = self.driven(here)
        return _along(step) if step is not None else None

    def driven(self, here: PlanarPose | None) -> PlanarPose | None:
        """Return the way since the first tap, to the last tap once the procedure is complete,
        else to `here`.
        """
        first = next((self.taps[step.key] for step in self.table if step.key in self.taps), None)
        if self.is_complete:
            here = self.taps[self.table[-1].key].world_from_base
        return first.world_from_base.between(here) if first is not None and here is not None else None

    def _back(self) -> "GuideProgress":
        """Forget the tap of the step that is gone back to, and all after it."""
        number = self.number - 1
        if self.step.needs_tap and self.step.key in self.taps:
            number = self.number
        gone = {step.key for step in self.table[number:]}
        kept = {key: tap for key, tap in self.taps.items() if key not in gone}
        return replace(self, number=number, taps=kept, rough=None)


def is_turn_then_advance(step: PlanarPose) -> bool:
    """Tell whether the way can be told as a turn on the spot and then an advance: it ends on the new
    heading's line.
    """
    return abs(_across(step)) <= max(STRAIGHT, 0.05 * abs(_along(step)))


def _along(step: PlanarPose) -> float:
    return step.x * math.cos(step.heading) + step.y * math.sin(step.heading)


def _across(step: PlanarPose) -> float:
    return step.y * math.cos(step.heading) - step.x * math.sin(step.heading)


def in_degrees(angle: float | None) -> float | None:
    """Return the angle as a person reads it."""
    return None if angle is None else degrees(angle)
