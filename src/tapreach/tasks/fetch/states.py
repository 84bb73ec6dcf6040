"""The states of fetching as a table: what is done in each, how it can end, and what then comes.

Pure data; tasks/fetch/task.py carries it out and docs/fetch.md shows it as a picture made from here.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from tapreach.errors import InputError


class Phase(StrEnum):
    """What fetching is at."""

    LOOK = "look"
    PREVIEW = "preview"
    CONFIRM = "confirm"
    ZERO = "zero"
    APPROACH = "approach"
    LAST_LOOK = "last_look"
    REACH = "reach"
    GRIP = "grip"
    LIFT = "lift"
    VERIFY = "verify"
    BACK_OFF = "back_off"
    HELD = "held"
    PLANNED = "planned"
    REFUSED = "refused"
    FAILED = "failed"


class Outcome(StrEnum):
    """How a phase ends."""

    DONE = "done"
    ASK = "ask"
    """The operator wants to confirm first."""
    PLAN_ONLY = "plan_only"
    CANNOT = "cannot"
    """It cannot be done, for a reason that more trying does not change."""
    LOST = "lost"
    """The thing is not seen any more, or is not where it was."""
    MISSED = "missed"
    """The claw has nothing in it; at the last look: it is to be gripped from elsewhere."""
    UNSURE = "unsure"
    """It is seen, but where it is is not known well enough."""


@dataclass(frozen=True)
class State:
    """A row of the table.

    does: a clause for people. progress: share of the whole that lies behind when it begins. after: what
    comes after each way it can end; empty for an end. if_stopped: the condition the robot is left in when
    somebody stops it here. resumes_at: where fetching goes on after such a stop.
    """

    does: str
    progress: float
    after: Mapping[Outcome, Phase]
    if_stopped: str = ""
    resumes_at: Phase | None = None


_STANDS = "the robot stands, the arm is folded"
_HOLDS_OUT = "the robot stands, the arm holds its pose before the thing"

STATES: Mapping[Phase, State] = {
    Phase.LOOK: State(
        "finds out where the thing is and how large",
        0.0,
        {
            Outcome.DONE: Phase.PREVIEW,
            Outcome.LOST: Phase.FAILED,
            Outcome.UNSURE: Phase.FAILED,
            Outcome.CANNOT: Phase.REFUSED,
        },
        _STANDS,
        Phase.LOOK,
    ),
    Phase.PREVIEW: State(
        "finds out whether and how it can be fetched",
        0.25,
        {
            Outcome.DONE: Phase.ZERO,
            Outcome.ASK: Phase.CONFIRM,
            Outcome.PLAN_ONLY: Phase.PLANNED,
            Outcome.CANNOT: Phase.REFUSED,
        },
        _STANDS,
        Phase.LOOK,
    ),
    Phase.CONFIRM: State(
        "waits for the operator's word", 0.3, {Outcome.DONE: Phase.ZERO}, _STANDS, Phase.LOOK
    ),
    Phase.ZERO: State(
        "looks at its own claw, to know where it really is",
        0.3,
        {Outcome.DONE: Phase.APPROACH, Outcome.CANNOT: Phase.REFUSED},
        "the robot stands, the arm holds its pose",
        Phase.LOOK,
    ),
    Phase.APPROACH: State(
        "drives to where it sees the whole thing from near",
        0.4,
        {
            Outcome.DONE: Phase.LAST_LOOK,
            Outcome.UNSURE: Phase.LOOK,
            Outcome.LOST: Phase.FAILED,
            Outcome.CANNOT: Phase.REFUSED,
        },
        _STANDS,
        Phase.LOOK,
    ),
    Phase.LAST_LOOK: State(
        "measures the thing once more and plans the grasp",
        0.6,
        {
            Outcome.DONE: Phase.REACH,
            Outcome.MISSED: Phase.APPROACH,
            Outcome.UNSURE: Phase.LOOK,
            Outcome.LOST: Phase.FAILED,
            Outcome.CANNOT: Phase.REFUSED,
        },
        _STANDS,
        Phase.LOOK,
    ),
    Phase.REACH: State(
        "brings the open claw around the thing",
        0.7,
        {Outcome.DONE: Phase.GRIP, Outcome.CANNOT: Phase.BACK_OFF},
        _HOLDS_OUT,
        Phase.BACK_OFF,
    ),
    Phase.GRIP: State(
        "closes the claw",
        0.8,
        {Outcome.DONE: Phase.LIFT},
        "the robot stands, the claw holds what it has around it",
        Phase.LIFT,
    ),
    Phase.LIFT: State(
        "lifts",
        0.85,
        {Outcome.DONE: Phase.VERIFY, Outcome.CANNOT: Phase.BACK_OFF},
        "the robot stands, the claw holds what it has, at the height where it is",
        Phase.LIFT,
    ),
    Phase.VERIFY: State(
        "looks whether the thing is in the claw",
        0.9,
        {Outcome.DONE: Phase.HELD, Outcome.MISSED: Phase.BACK_OFF},
        "the robot stands, the claw holds what it has, lifted",
        Phase.VERIFY,
    ),
    Phase.BACK_OFF: State(
        "opens the claw, backs off and looks for the thing again",
        0.55,
        {Outcome.DONE: Phase.LOOK, Outcome.LOST: Phase.FAILED, Outcome.CANNOT: Phase.FAILED},
        "the robot stands, the claw is open",
        Phase.BACK_OFF,
    ),
    Phase.HELD: State("holds the thing", 1.0, {}, "the robot stands and holds the thing"),
    Phase.PLANNED: State("has planned, as asked, and does no more", 1.0, {}),
    Phase.REFUSED: State("does not try, and says why", 1.0, {}),
    Phase.FAILED: State("has tried, and says what happened", 1.0, {}),
}

FIRST = Phase.LOOK
ATTEMPTS = 2
"""How often the claw is closed: once, and once more from a new estimate."""


def next_phase(phase: Phase, outcome: Outcome, attempts: int) -> Phase:
    """Return what comes after `phase` ended with `outcome`, the claw having been closed `attempts` times.

    A miss after the last attempt is a failure. Raises InputError for an outcome the phase does not have.
    """
    after = STATES[phase].after
    if outcome not in after:
        known = ", ".join(after) or "none: it is an end"
        raise InputError(f"{phase} cannot end as {outcome}; it ends as: {known}")
    following = after[outcome]
    return Phase.FAILED if following is Phase.BACK_OFF and attempts >= ATTEMPTS else following


def is_end(phase: Phase) -> bool:
    """Return whether nothing comes after `phase`."""
    return not STATES[phase].after


def resumed_at(phase: Phase) -> Phase | None:
    """Return where fetching goes on when it was stopped in `phase`; None after an end."""
    return STATES[phase].resumes_at
