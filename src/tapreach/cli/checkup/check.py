"""One thing that was looked at, how it is, and what to do about it."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum


class Verdict(StrEnum):
    """How it is. In order: a later one is worse."""

    OK = "ok"
    WARN = "warn"
    FAIL = "fail"


@dataclass(frozen=True, slots=True)
class Check:
    """`found` is what was seen, `advice` what to do next ('' where nothing is to be done).

    `figures` are the measured values by name, the unit in the name.
    """

    name: str
    verdict: Verdict
    found: str
    advice: str = ""
    figures: dict[str, float | str] = field(default_factory=dict)


def worst(checks: Iterable[Check]) -> Verdict:
    """Return the worst verdict; ok for none."""
    order = list(Verdict)
    return max((check.verdict for check in checks), key=order.index, default=Verdict.OK)


def graded(value: float, warn_at: float, fail_at: float) -> Verdict:
    """Return the verdict of a value that is worse the further it lies from `warn_at` towards `fail_at`."""
    sign = 1.0 if fail_at > warn_at else -1.0
    if sign * value >= sign * fail_at:
        return Verdict.FAIL
    return Verdict.WARN if sign * value >= sign * warn_at else Verdict.OK
