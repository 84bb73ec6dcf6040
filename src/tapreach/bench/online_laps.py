"""Processor time of each step of the online path, from a real locating run that is played again."""

from collections.abc import Callable, Coroutine, Generator
from dataclasses import dataclass, field
from typing import Any, TypeVar

from tapreach.geometry.pixel import Pixel
from tapreach.robot.clock import MS, processor_ns
from tapreach.robot.config import RobotDescription
from tapreach.tasks import following
from tapreach.tasks.background_watch import BackgroundWatch
from tapreach.tasks.compute import InlineCompute
from tapreach.tasks.guessing import guesses_for
from tapreach.tasks.online import online_picture
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target_watch import Followed, Shot
from tapreach.vision.image_io import BrokenPicture, Gray, decode_gray
from tapreach.vision.tracker import PatchTracker

T = TypeVar("T")
WHOLE_FRAME = "frame, whole"
LOOP = "event loop, mean a frame"
_NO_FRAME = "a frame that was followed cannot be decoded again"


def processor_ms() -> float:
    """Return the processor time of this thread so far [ms]."""
    return processor_ns() / MS


@dataclass
class Laps:
    """Times [ms] by the name of the step."""

    by_step: dict[str, list[float]] = field(default_factory=dict)

    def timed(self, step: str, function: Callable[..., T], *arguments: Any) -> T:
        """Call the function, note its time, return its result."""
        began = processor_ms()
        try:
            return function(*arguments)
        finally:
            self.note(step, processor_ms() - began)

    def note(self, step: str, took_ms: float) -> None:
        """Note one time."""
        self.by_step.setdefault(step, []).append(took_ms)


@dataclass
class RecordingCompute(InlineCompute):
    """Computes in place, keeps the calls with what they returned, and adds up its time."""

    calls: list[tuple[Callable[..., Any], tuple[Any, ...], Any]] = field(default_factory=list)
    total_ms: float = 0.0

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        """See Compute."""
        began = processor_ms()
        try:
            result = function(*arguments)
            self.calls.append((function, arguments, result))
            return result
        finally:
            self.total_ms += processor_ms() - began


class Stepped:
    """Awaits a coroutine and adds up the processor time of its steps in the event loop [ms]."""

    def __init__(self, coroutine: Coroutine[Any, Any, T]) -> None:
        self._coroutine = coroutine
        self.total_ms = 0.0

    def __await__(self) -> Generator[Any, Any, Any]:
        value: Any = None
        while True:
            began = processor_ms()
            try:
                waits_for = self._coroutine.send(value)
            except StopIteration as end:
                return end.value
            finally:
                self.total_ms += processor_ms() - began
            value = yield waits_for


def replay(compute: RecordingCompute, description: RobotDescription, laps: Laps) -> None:
    """Play a recorded run again, each step on its own and whole frames beside it."""
    opened = next(arguments for function, arguments, _ in compute.calls if function is following.open_track)
    shots = [
        (arguments[1], result)
        for function, arguments, result in compute.calls
        if function is following.follow
    ]
    _replay_parts(opened[1], opened[2], shots, description, laps)
    laps.timed("tapped frame, whole", following.open_track, *opened)
    for function, arguments, _ in compute.calls:
        if function is following.follow:
            laps.timed(WHOLE_FRAME, function, *arguments)
        elif function is online_picture:
            laps.timed("estimate on the way, shown", function, *arguments)
    following.close_track(opened[0])


def _replay_parts(
    tapped: Shot, place: Pixel, shots: list[tuple[Shot, Followed]], description: RobotDescription, laps: Laps
) -> None:
    picture = _picture(tapped, laps)
    tracker = PatchTracker(picture, place.u, place.v)
    background = BackgroundWatch(picture, tapped.frame_id, tapped.world_from_base, description)
    last = Sighting(tapped.frame_id, tapped.captured_ns, place, 0.3, 1.0, tapped.world_from_base)
    for shot, followed in shots:
        picture = _picture(shot, laps)
        guesses = laps.timed("guesses", guesses_for, last, shot.world_from_base, description)
        laps.timed("tapped place followed", tracker.follow, picture, guesses)
        laps.timed("background followed", background.follow, picture)
        seen = followed.sighting
        if seen is None:
            continue
        last = seen
        if seen.way is not None:
            laps.timed("way by the background", background.way_to, seen.world_from_base)
        if seen.is_key:
            laps.timed("new key frame", background.renew, picture, seen.frame_id, seen.world_from_base)


def _picture(shot: Shot, laps: Laps) -> Gray:
    picture = laps.timed("decoded", decode_gray, shot.jpeg)
    if isinstance(picture, BrokenPicture):
        raise ValueError(_NO_FRAME)
    return picture
