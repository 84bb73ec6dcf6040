"""What a robot on a serial link is put together from."""

from collections.abc import Callable
from typing import Any, Protocol

from tapreach.robot.clock import Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.interface import Arm, Base, FrameSource, Listeners, Unsubscribe
from tapreach.robot.messages import Frame


class CameraStatus(Protocol):
    """Whether pictures come, and why not."""

    @property
    def is_running(self) -> bool:
        """True while they come."""
        ...

    @property
    def reason(self) -> str:
        """The sentence to show when they do not."""
        ...


class RobotCamera(FrameSource, Protocol):
    """A camera that opens by itself, as long as it takes, and again when it was lost."""

    @property
    def status(self) -> CameraStatus:
        """Present state."""
        ...

    def subscribe_status(self, listener: Callable[[Any], None]) -> Unsubscribe:
        """Hear every change of `status`."""
        ...

    def start(self) -> None:
        """Begin to open it; in the event loop's thread."""
        ...

    async def close(self) -> None:
        """Let go of it; twice does no harm."""
        ...


CameraFactory = Callable[[RobotDescription, Clock], RobotCamera]


class NoCameraStatus:
    """Of a robot without a camera: nothing is missing."""

    is_running = True
    reason = ""


class NoCamera:
    """A robot file without [camera] source: the wheels and the arm alone, for benches and first drives."""

    status = NoCameraStatus()

    def __init__(self) -> None:
        self._listeners = Listeners()

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """See FrameSource. No frame ever comes."""
        return self._listeners.subscribe(listener)

    def subscribe_status(self, listener: Callable[[Any], None]) -> Unsubscribe:
        """See RobotCamera."""
        return self._listeners.subscribe(listener)

    def start(self) -> None:
        """See RobotCamera."""

    async def close(self) -> None:
        """See RobotCamera."""


class Board(Protocol):
    """What speaks with the microcontroller, in whichever protocol."""

    @property
    def base(self) -> Base:
        """The wheels."""
        ...

    @property
    def arm(self) -> Arm:
        """The servos."""
        ...

    @property
    def is_serving(self) -> bool:
        """True while the board answers."""
        ...

    def found(self) -> None:
        """The link is open."""
        ...

    def heard(self, data: bytes) -> None:
        """Take bytes from the link."""
        ...

    def lost(self, reason: str) -> None:
        """The link is gone."""
        ...

    def tick(self) -> str:
        """Do what the time asks for. Returns why the link should be opened anew, or ''."""
        ...

    def halt(self) -> None:
        """Wheels off, as far as somebody hears it."""
        ...
