"""Why locating ends, and the sentence that says so."""

from enum import StrEnum

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.tasks.move_choice import Choice
from tapreach.tasks.target import Target

WORTHWHILE = 0.7
"""A further move is made when it promises to bring the range's error below this share of what it is."""

HELPED = 0.9


class End(StrEnum):
    """What ended the search for a better answer."""

    REACHED = "reached"
    NO_GAIN = "no_gain"
    WAY_USED_UP = "way_used_up"
    NO_MOVE = "no_move"
    LOST = "lost"


def is_worthwhile(choice: Choice, estimate: PointEstimate | None) -> bool:
    """Tell whether a move promises enough to be made; while nothing is determined any does."""
    if estimate is None or estimate.status is not Status.DETERMINED:
        return True
    return choice.relative_sd < WORTHWHILE * estimate.relative_sd


def has_helped(before: PointEstimate | None, now: PointEstimate | None) -> bool:
    """Tell whether a move has made the range's error smaller by a tenth, or there was none before."""
    if before is None or now is None or before.status is not Status.DETERMINED:
        return True
    return now.relative_sd < HELPED * before.relative_sd


def closing_sentence(
    target: Target, estimate: PointEstimate, end: End, wanted: float, way_left: float, loss: str
) -> str:
    """Return what was found and why nothing more was done, for a target that has a position.

    wanted: the relative error that was. way_left [m]: what might still be driven.
    """
    assert target.range is not None and target.range_interval is not None
    low, high = target.range_interval
    found = f"{target.range:.2f} m away (95 %: {low:.2f} to {high:.2f} m)"
    known = f"known to {_percent(estimate.relative_sd)}"
    if end is End.REACHED:
        return f"{found}: {known}, {_percent(wanted)} was wanted"
    if end is End.LOST:
        return f"{found}: {known}; lost on the way ({loss}), from the views before"
    why = {
        End.NO_GAIN: f"the {way_left:.2f} m that it may still drive would not help much",
        End.WAY_USED_UP: "the way it may drive is used up",
        End.NO_MOVE: "no further move keeps it in the picture",
    }[end]
    return f"{found}: {known}; {why}" + (f". Adviser: {target.advice}" if target.advice else "")


def _percent(relative_sd: float) -> str:
    return f"{100.0 * relative_sd:.2g} %"
