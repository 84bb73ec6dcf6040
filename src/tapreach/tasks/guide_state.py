"""A guided procedure as a table of steps, and what the page shows of it."""

from dataclasses import dataclass
from enum import StrEnum


class GuideKind(StrEnum):
    """The procedures there are."""

    TWO_TAP = "two_tap"
    ROTATION_CENTRE = "rotation_centre"


@dataclass(frozen=True, slots=True)
class Step:
    """One row of the table. key: what the procedure calls it; act: what the robot can do by itself ('' for
    nothing).

    wants_tap: a tap on the picture belongs to it. needs_tap: one can go on only after the tap, which does
    so by itself.
    """

    key: str
    title: str
    instruction: str
    act: str = ""
    wants_tap: bool = False
    needs_tap: bool = False


@dataclass(frozen=True, slots=True)
class GuideState:
    """What the page shows; the fields of its guide message. step counts from 1 to steps; kind None: no
    guide is open.

    acts: what may be asked for now. values_typed: names of the values that a person has typed over the
    odometry's.
    """

    kind: GuideKind | None
    step: int = 0
    steps: int = 0
    title: str = ""
    instruction: str = ""
    hint: str = ""
    acts: tuple[str, ...] = ()
    wants_tap: bool = False
    theta_deg: float | None = None
    distance: float | None = None
    values_typed: tuple[str, ...] = ()
    result: str = ""


CLOSED = GuideState(None)
