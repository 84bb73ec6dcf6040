"""Messages about fetching; a part of messages.py."""

from typing import Literal

from pydantic import Field

from tapreach.server.message_base import Finite, FrameId, Message, Request

VerbName = Literal["bring_back", "put_down", "hand_over", "let_go"]


class Fetch(Request):
    """Fetch what was tapped or boxed, or a target that is known (`target_id`, then no tap).

    'plan': say whether and how; 'confirm': then wait for `fetch_confirm`; 'go': do it."""

    type: Literal["fetch"]
    mode: Literal["plan", "confirm", "go"]
    frame_id: FrameId | None = None
    u: Finite | None = Field(None, description="as in tap")
    v: Finite | None = None
    box: tuple[Finite, Finite, Finite, Finite] | None = Field(None, description="as in tap")
    target_id: int | None = Field(None, description="a target with a position; it must be in the picture")


class FetchConfirm(Request):
    """Yes, fetch it as planned."""

    type: Literal["fetch_confirm"]


class FetchResume(Request):
    """Go on with the fetch that was stopped."""

    type: Literal["fetch_resume"]


class FetchVerb(Request):
    """What to do with the thing that is held."""

    type: Literal["fetch_verb"]
    verb: VerbName


class FetchView(Message):
    """Where fetching stands. Lengths in metres, world frame."""

    type: Literal["fetch"] = "fetch"
    phase: str | None = Field(description="null: nothing is being fetched")
    target_id: int | None = None
    does: str = Field("", description="what the robot does in this phase")
    why: str = Field("", description="the reason for the newest decision")
    next: str = Field("", description="what comes if all goes well")
    progress: float = 0.0
    attempt: int = 1
    verdict: Literal["yes", "unsure", "no"] | None = Field(None, description="can it be fetched")
    reason: str = ""
    advice: str = ""
    seconds: float | None = Field(None, description="expected time until it is lifted")
    path: tuple[tuple[float, float, float], ...] = Field(
        (), description="x, y, heading of the base, from where it was when planning"
    )
    grasp: tuple[tuple[tuple[float, float], ...], ...] = Field((), description="the claw on the floor plan")
    may_confirm: bool = False
    may_resume: bool = False
    stopped: str = Field("", description="who or what stopped it")
    condition: str = Field("", description="how the robot stands after the stop")
    verbs: tuple[VerbName, ...] = ()


NOTHING_FETCHED = FetchView(phase=None)
