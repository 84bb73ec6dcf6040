"""What is told of fetching while it goes on: the phase, why, what is next, and the plan."""

from dataclasses import dataclass, field
from enum import StrEnum

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.reach import Verdict
from tapreach.tasks.fetch.states import STATES, Phase, is_end


class Mode(StrEnum):
    """How far fetching goes by itself."""

    PLAN = "plan"
    CONFIRM = "confirm"
    GO = "go"


class Verb(StrEnum):
    """What can be done with a thing that is held."""

    BRING_BACK = "bring_back"
    PUT_DOWN = "put_down"
    HAND_OVER = "hand_over"
    LET_GO = "let_go"


@dataclass(frozen=True)
class FetchPlan:
    """What is planned, for people: whether it can be fetched, why not or what would help, and what to draw.

    path: base poses in the world, from the present one to where the arm reaches out. outline (n, 2) [m]: the
    base on the floor, in its own frame. grasp_lines_in_world: lines (n, 3) [m] of the claw at the thing.
    seconds: expected time until it is lifted; None where there is no plan.
    """

    verdict: Verdict
    reason: str
    advice: str = ""
    path: tuple[PlanarPose, ...] = ()
    grasp_lines_in_world: tuple[FloatArray, ...] = ()
    seconds: float | None = None


@dataclass(frozen=True)
class FetchState:
    """Where fetching stands.

    why: the reason for the newest decision. attempt: counted from 1. stopped: who or what stopped it, ''
    while it goes on. verbs: what can be done now with the thing that is held.
    """

    phase: Phase
    target_id: int
    why: str = ""
    attempt: int = 1
    plan: FetchPlan | None = None
    stopped: str = ""
    verbs: tuple[Verb, ...] = field(default=())

    @property
    def next_in_words(self) -> str:
        """What comes if all goes well; '' at an end."""
        return "" if is_end(self.phase) else STATES[next(iter(STATES[self.phase].after.values()))].does

    @property
    def condition(self) -> str:
        """How the robot stands after a stop; '' while it goes on."""
        return STATES[self.phase].if_stopped if self.stopped else ""

    @property
    def may_confirm(self) -> bool:
        """Whether it waits for the operator's word."""
        return self.phase is Phase.CONFIRM and not self.stopped

    @property
    def may_resume(self) -> bool:
        """Whether it can go on after a stop."""
        return bool(self.stopped) and STATES[self.phase].resumes_at is not None
