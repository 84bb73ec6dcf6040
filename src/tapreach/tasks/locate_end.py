"""Why locating ends, and the sentence that says so."""

from enum import StrEnum

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.tasks.move_choice import Choice
from tapreach.tasks.target import Target

WORTHWHILE = 0.85
"""A further move is made when it promises to bring the range's error below this share of what it is."""
HELPED = 0.9
"""After a move that did not bring it below this share nothing more is tried."""


class End(StrEnum):
    """What ended the search for a better answer."""

    REACHED = "reached"
    NO_GAIN = "no_gain"
    WAY_USED_UP = "way_used_up"
    NO_MOVE = "no_move"
    LOST = "lost"
    OBSTRUCTED = "obstructed"


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


def closing_sentence(target: Target) -> str:
    """Return what was found, why nothing more was done, and what would help, of a target with a position."""
    assert target.range is not None and target.range_interval is not None
    low, high = target.range_interval
    found = f"{target.range:.2f} m away (95 %: {low:.2f} to {high:.2f} m): {target.reason}"
    return f"{found}. Adviser: {target.advice}" if target.advice else found


def closing_reason(
    relative_sd: float, end: End, wanted: float, way_left: float, loss: str, obstruction: str = ""
) -> str:
    """Return how well the range is known (one sigma) and why no more was done for it.

    wanted: the relative error that was. way_left [m]: what might still be driven. loss: why it was lost.
    obstruction: what kept the robot from driving on.
    """
    known = f"range known to {_percent(relative_sd)}"
    if end is End.REACHED:
        return f"{known}, {_percent(wanted)} was wanted"
    if end is End.LOST:
        return f"{known}; lost on the way ({loss}), from the views before"
    why = {
        End.NO_GAIN: f"the {way_left:.2f} m left to drive would not help much",
        End.WAY_USED_UP: "the way it may drive is used up",
        End.OBSTRUCTED: obstruction,
        End.NO_MOVE: "no further move keeps it in the picture",
    }[end]
    return f"{known}; {why}"


def _percent(relative_sd: float) -> str:
    return f"{100.0 * relative_sd:.2g} %"
