"""What a task is: a coroutine with phases that anyone can see and stop."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol, TypeVar

from tapreach.control.pilot import Pilot
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.pixel_box import PixelBox
from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.interface import Robot
from tapreach.robot.messages import Frame
from tapreach.tasks.delay_kept import DelayKept
from tapreach.tasks.fetch.fetch_state import FetchState
from tapreach.tasks.planned_move import PlannedMove
from tapreach.tasks.target import Target

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Tap:
    """A touched pixel of the frame that was on the screen, or a box drawn on it around a thing.

    With a box, (u, v) is a place inside it; a task may choose another one there that it can follow better.
    """

    frame_id: int
    u: float
    v: float
    box: PixelBox | None = None

    @classmethod
    def around(cls, frame_id: int, box: PixelBox) -> "Tap":
        """Return the tap on what `box` holds: its position, and its size as well."""
        return cls(frame_id, box.middle.u, box.middle.v, box)


class TaskState(StrEnum):
    """Where a task stands."""

    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(frozen=True, slots=True)
class TaskReport:
    """One line for the page: phase, progress from 0 to 1, and a sentence."""

    phase: str
    progress: float
    message: str


class Compute(Protocol):
    """Runs plain functions where they cannot hold up the control loop: in another process."""

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        """Run a module-level function with picklable arguments. Errors come back as raised."""
        ...


@dataclass(frozen=True)
class TaskContext:
    """All that a task may touch."""

    description: RobotDescription
    robot: Robot
    pilot: Pilot
    frames: FrameStore
    poses: PoseHistory
    compute: Compute
    clock: Clock
    next_frame: Callable[[int], Awaitable[Frame]]
    """Wait for a frame newer than the given id. Raises LinkLost when the camera is silent for 2 s."""
    report: Callable[[TaskReport], None]
    """Show a line on the page."""
    show_target: Callable[[Target], None]
    """Show or update a target on the page (newest wins, by target_id)."""
    show_move: Callable[[PlannedMove | None], None] = lambda _: None
    """Show the move that is about to be made; None: it is over."""
    show_fetch: Callable[[FetchState | None], None] = lambda _: None
    """Show where fetching stands; None: nothing is being fetched or held."""
    camera_delay: DelayKept = field(default_factory=DelayKept)
    """How late pictures are beyond their stamps, as far as that was measured; shared by all tasks."""


class Task(Protocol):
    """Something the robot does by itself, under the eyes of an operator."""

    @property
    def kind(self) -> str:
        """What the page calls it."""
        ...

    async def run(self, context: TaskContext) -> str:
        """Do it and return the closing sentence. Raises TapreachError with a reason when it cannot be done.

        Cancellation arrives as asyncio.CancelledError; the wheels are then already stopped.
        """
        ...
