"""What the server tells, as far as a script needs it; keys that are not known here are passed over.

docs/protocol.md describes all of it; a test holds these against the server's own messages.
"""

from typing import Literal

from pydantic import BaseModel, ConfigDict

PROTOCOL_VERSION = 1
Verb = Literal["bring_back", "put_down", "hand_over", "let_go"]


class News(BaseModel):
    """Base: values from outside, checked, frozen."""

    model_config = ConfigDict(extra="ignore", frozen=True)


class Lens(News):
    """Size of the camera's full picture [px]."""

    width: int
    height: int


class Greeting(News):
    """The server's answer to hello."""

    protocol_version: int
    session_id: int
    robot: str
    camera: Lens


class LeaseNews(News):
    """Who drives."""

    holder_id: int | None
    holder_name: str
    asked_by_id: int | None


class StateNews(News):
    """Ten times a second: who drives, and what stands in the way."""

    lease: LeaseNews
    emergency_stop: str


class TaskNews(News):
    """The running or last task, whatever it is. progress: from 0 to 1."""

    task_id: int
    kind: str
    state: Literal["running", "done", "failed", "cancelled"]
    phase: str
    progress: float
    message: str


class FetchNews(News):
    """Where fetching stands: one phase of it. Lengths in metres, world frame.

    phase: None when nothing is being fetched or held. does: what the robot does in it; why: the reason for
    the newest decision; next: what comes if all goes well. verdict, reason, advice, seconds, path and
    grasp: the plan, once there is one. stopped: who or what stopped it; condition: how the robot then stands.
    """

    phase: str | None
    target_id: int | None
    does: str
    why: str
    next: str
    progress: float
    attempt: int
    verdict: Literal["yes", "unsure", "no"] | None
    reason: str
    advice: str
    seconds: float | None
    path: tuple[tuple[float, float, float], ...]
    grasp: tuple[tuple[tuple[float, float], ...], ...]
    may_confirm: bool
    may_resume: bool
    stopped: str
    condition: str
    verbs: tuple[Verb, ...]

    @property
    def is_final(self) -> bool:
        """Whether nothing more comes of it by itself."""
        return bool(self.stopped) or self.phase in (None, "held", "planned", "refused", "failed")


class TargetNews(News):
    """A target and its position [m], None where there is no answer; see `target` in docs/protocol.md."""

    target_id: int
    source: str
    status: str
    reason: str
    advice: str
    frame_id: int
    point_in_base: tuple[float, float, float] | None
    point_in_world: tuple[float, float, float] | None
    sigma: tuple[float, float, float] | None
    range: float | None
    range_low: float | None
    range_high: float | None
