"""One measured number, the limit it is held to, and what kind of number it is."""

import math
from dataclasses import dataclass
from typing import Literal

Sense = Literal["≤", "≥", "="]


@dataclass(frozen=True)
class Limit:
    """What is wanted of a figure: at most, at least, or exactly `value`."""

    sense: Sense
    value: float

    def holds(self, value: float) -> bool:
        """Tell whether `value` keeps to the limit."""
        if self.sense == "≤":
            return value <= self.value
        if self.sense == "≥":
            return value >= self.value
        return value == self.value

    def __str__(self) -> str:
        return f"{self.sense} {plain(self.value)}"


@dataclass(frozen=True)
class Band:
    """What is wanted of a figure: from `low` to `high`, both included."""

    low: float
    high: float

    def holds(self, value: float) -> bool:
        """Tell whether `value` lies in the band."""
        return self.low <= value <= self.high

    def __str__(self) -> str:
        return f"{plain(self.low)} to {plain(self.high)}"


def at_most(value: float) -> Limit:
    """Return the limit "no more than `value`"."""
    return Limit("≤", value)


def at_least(value: float) -> Limit:
    """Return the limit "no less than `value`"."""
    return Limit("≥", value)


def exactly(value: float) -> Limit:
    """Return the limit "`value` and nothing else": for counts."""
    return Limit("=", value)


def within(low: float, high: float) -> Band:
    """Return the limit "from `low` to `high`"."""
    return Band(low, high)


@dataclass(frozen=True)
class Figure:
    """A measured value. `value` None: could not be measured here, and `note` says why.

    Milliseconds belong to the machine they were measured on; what carries over to another are ratios and
    counts, so limits are mostly set on those.
    """

    name: str
    value: float | None
    unit: str = ""
    limit: Limit | Band | None = None
    note: str = ""

    @property
    def holds(self) -> bool | None:
        """True or False against the limit; None without a limit. What was not measured does not hold."""
        if self.limit is None:
            return None
        return self.value is not None and self.limit.holds(self.value)

    @property
    def wanted(self) -> str:
        """The limit as a person reads it, '' without one."""
        return "" if self.limit is None else f"{self.limit} {self.unit}".strip()

    @property
    def shown(self) -> str:
        """The value with its unit, three significant digits; '—' when it was not measured."""
        return "—" if self.value is None else f"{plain(self.value)} {self.unit}".strip()


def known(value: float) -> float | None:
    """Return the value of a figure: None for NaN, what a mean over nothing is."""
    return None if math.isnan(value) else value


def plain(value: float) -> str:
    """Write a number with three significant digits, without an exponent, whole numbers whole."""
    if value == int(value) and abs(value) < 1e9:
        return str(int(value))
    digits = 3 if abs(value) < 1 else 2 if abs(value) < 10 else 1 if abs(value) < 100 else 0
    return f"{value:.{digits}f}"
