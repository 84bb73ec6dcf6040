"""Every message of the control socket, as JSON objects told apart by `type`.

This file is the one definition: `web/net/messages.js` and `docs/protocol.md` are generated from it.
Each message from the page carries `seq` and is answered by exactly one `ack` (or `pong`, `welcome`)
with that number.
"""

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from tapreach.server.message_base import Finite, FrameId, Message, Request, Timed
from tapreach.server.message_parts import (
    ArmView,
    CameraView,
    ExtentView,
    LeaseView,
    OdometryView,
    TwistView,
)
from tapreach.server.messages_fetch import Fetch, FetchConfirm, FetchResume, FetchVerb, FetchView
from tapreach.server.messages_lesson import LessonAnswer, LessonEnd, LessonName, LessonStart, LessonView

PROTOCOL_VERSION = 1
Accuracy = Annotated[float, Field(ge=0.001, le=0.5, allow_inf_nan=False)]
ArmControl = Literal["T", "R", "left", "right", "forward", "backward"]
GuideKind = Literal["two_tap", "rotation_centre"]


class Hello(Request):
    """First message of a session."""

    type: Literal["hello"]
    name: str = Field("", max_length=40, description="shown to others: 'who drives'")


class Ping(Request):
    """Measures round trip and clock offset; once a second."""

    type: Literal["ping"]
    client_ms: Finite


class Heartbeat(Timed):
    """The operator is there: 20 Hz while holding the lease, from a worker fed by the page."""

    type: Literal["heartbeat"]


class Drive(Timed):
    """Hold to drive: 20 Hz while held."""

    type: Literal["drive"]
    linear: Finite = Field(description="[m/s]")
    angular: Finite = Field(description="[rad/s], left positive")


class Stop(Request):
    """Zero speed now; ends a running task."""

    type: Literal["stop"]
    reason: Literal["release", "blur", "hidden", "pagehide", "button", "key"]


class EmergencyStop(Request):
    """Latched stop: anyone connected may send it, lease or not."""

    type: Literal["emergency_stop"]


class EmergencyReset(Request):
    """Unlatch; the lease holder only."""

    type: Literal["emergency_reset"]


class ArmStep(Timed):
    """One press of an arm control: T clamps, R releases, left/right turn A, forward/backward move B and C."""

    type: Literal["arm_step"]
    control: ArmControl
    step_deg: Literal[1, 5, 10, 20, 50]


class ArmGoto(Timed):
    """Send the arm to a named pose."""

    type: Literal["arm_goto"]
    pose: Literal["standard", "stowed"]


class Capture(Request):
    """Store a frame on the robot's side; null: the newest."""

    type: Literal["capture"]
    frame_id: FrameId | None


class LeaseRequest(Request):
    """Ask to drive: granted at once when free or idle, else the holder is asked."""

    type: Literal["lease_request"]


class LeaseRelease(Request):
    """Give the lease back."""

    type: Literal["lease_release"]


class LeaseAnswer(Request):
    """The holder's answer to whoever asked."""

    type: Literal["lease_answer"]
    session_id: int
    grant: bool


class TapTarget(Request):
    """A tap on the picture, or a box drawn around a thing, which gives its size as well.

    'floor': at once, from one view; 'locate': the robot moves to find out."""

    type: Literal["tap"]
    frame_id: FrameId
    u: Finite = Field(description="column, centre of the left-most pixel is 0 [px]")
    v: Finite = Field(description="row, centre of the top-most pixel is 0 [px]")
    purpose: Literal["locate", "floor"]
    box: tuple[Finite, Finite, Finite, Finite] | None = Field(
        None, description="left, top, right, bottom [px]; u and v are then its middle"
    )
    accuracy: Accuracy | None = Field(
        None, description="locate: relative error of the range, one sigma, that is good enough; null: 0.01"
    )


class TargetClear(Request):
    """Forget a target."""

    type: Literal["target_clear"]
    target_id: int


class TaskCancel(Request):
    """Stop the running task at once."""

    type: Literal["task_cancel"]


class GuideStart(Request):
    """Begin a guided procedure."""

    type: Literal["guide_start"]
    kind: GuideKind


class GuideTap(Request):
    """A tap that belongs to the guide's present step."""

    type: Literal["guide_tap"]
    frame_id: FrameId
    u: Finite
    v: Finite


class GuideValue(Request):
    """Type a value over what odometry read; null takes the typed value back."""

    type: Literal["guide_value"]
    name: Literal["theta_deg", "distance"]
    value: Finite | None


class GuideAct(Request):
    """Let the robot do the step ('centre', 'turn', 'advance', 'pose'), confirm what was done by hand
    ('next'), or go back one step ('back')."""

    type: Literal["guide_act"]
    act: Literal["pose", "centre", "turn", "advance", "next", "back"]


class GuideEnd(Request):
    """Leave the guide."""

    type: Literal["guide_end"]


FromPage = Annotated[
    Hello
    | Ping
    | Heartbeat
    | Drive
    | Stop
    | EmergencyStop
    | EmergencyReset
    | ArmStep
    | ArmGoto
    | Capture
    | LeaseRequest
    | LeaseRelease
    | LeaseAnswer
    | TapTarget
    | TargetClear
    | TaskCancel
    | GuideStart
    | GuideTap
    | GuideValue
    | GuideAct
    | GuideEnd
    | Fetch
    | FetchConfirm
    | FetchResume
    | FetchVerb
    | LessonStart
    | LessonAnswer
    | LessonEnd,
    Field(discriminator="type"),
]
from_page: TypeAdapter[FromPage] = TypeAdapter(FromPage)


class Welcome(Message):
    """Answer to hello."""

    type: Literal["welcome"] = "welcome"
    seq: int
    protocol_version: int = PROTOCOL_VERSION
    session_id: int
    robot: str
    camera: CameraView
    max_linear: float
    max_angular: float
    steps_deg: tuple[int, ...] = (1, 5, 10, 20, 50)
    frozen_after_ms: int = 500
    stale_after_ms: int = 200
    lessons: tuple[LessonName, ...] = Field((), description="what this robot can be taught")


class Pong(Message):
    """Answer to ping."""

    type: Literal["pong"] = "pong"
    seq: int
    client_ms: float
    server_ns: int


class Ack(Message):
    """What became of a request. `sent` is what really went to the wheels, for drive and stop."""

    type: Literal["ack"] = "ack"
    seq: int | None = Field(description="null when the message was too broken to have one")
    ok: bool
    reason: str = ""
    sent: TwistView | None = None


class State(Message):
    """10 Hz, and at once when lease, stop or health change."""

    type: Literal["state"] = "state"
    server_ns: int
    sent: TwistView = Field(description="what really went to the wheels last")
    limited_by: str = Field(description="why less was sent than wished, '' when not")
    own_move: float | None = Field(
        None, description="how much of the move that the robot makes by itself is done, 0 to 1; null: none"
    )
    odometry: OdometryView | None
    arm: ArmView | None
    lease: LeaseView
    emergency_stop: str = Field(description="'' or who pressed it and when")
    health: Literal["starting", "running", "lost"]
    health_reason: str
    viewers: int
    overruns: int = Field(description="control periods that came late since the start")


class TaskView(Message):
    """The running or last task."""

    type: Literal["task"] = "task"
    task_id: int
    kind: str
    state: Literal["running", "done", "failed", "cancelled"]
    phase: str
    progress: float
    message: str


class TargetView(Message):
    """A target. Lengths in metres, world frame unless said; null where there is no answer."""

    type: Literal["target"] = "target"
    target_id: int
    source: Literal["floor", "locate", "two_tap"]
    status: str
    reason: str
    advice: str
    frame_id: int
    u: float
    v: float
    point_in_base: tuple[float, float, float] | None = Field(description="with the robot where it is now")
    point_in_world: tuple[float, float, float] | None
    sigma: tuple[float, float, float] | None = Field(description="one sigma of each coordinate in base")
    range: float | None
    range_low: float | None
    range_high: float | None = Field(description="null: open")
    region_in_world: tuple[tuple[float, float], ...] = Field(
        description="outline of the 95 % region on the floor"
    )
    rays_in_world: tuple[tuple[float, float, float, float], ...] = Field(description="x, y, direction x, y")
    is_following: bool
    extent: ExtentView | None = Field(None, description="null: no box was drawn, or no position yet")


class MoveView(Message):
    """The move that the running task is about to make or is making, on the floor in the world frame [m].

    Empty and null when there is none.
    """

    type: Literal["move"] = "move"
    tracks_in_world: tuple[tuple[tuple[float, float], ...], ...] = Field(
        description="the way of the robot's left side and of its right side, from start to end"
    )
    body_in_world: tuple[tuple[float, float], ...] = Field(description="the robot's corners at the end")
    words: str
    expected_sd: float | None = Field(description="one sigma of the target's range after it [m]")
    expected_relative_sd: float | None = Field(description="the same as a share of the range")


class TargetGone(Message):
    """A target was forgotten."""

    type: Literal["target_gone"] = "target_gone"
    target_id: int


class GuideView(Message):
    """A guided procedure, step by step. `kind` null: no guide is open."""

    type: Literal["guide"] = "guide"
    kind: GuideKind | None
    step: int = 0
    steps: int = 0
    title: str = ""
    instruction: str = ""
    hint: str = Field("", description="help for this step, such as 'turn 3° right'")
    acts: tuple[str, ...] = Field((), description="which guide_act make sense now")
    wants_tap: bool = False
    theta_deg: float | None = None
    distance: float | None = None
    values_typed: tuple[str, ...] = ()
    result: str = Field("", description="the answer in a few lines, '' until there is one")


class CapturesChanged(Message):
    """The list of captures is new: ask GET /api/captures."""

    type: Literal["captures_changed"] = "captures_changed"
    newest: str | None


FromServer = (
    Welcome
    | Pong
    | Ack
    | State
    | TaskView
    | MoveView
    | TargetView
    | TargetGone
    | GuideView
    | FetchView
    | LessonView
    | CapturesChanged
)
