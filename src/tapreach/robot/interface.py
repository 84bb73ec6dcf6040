"""What a robot is, to everything above the drivers. Every driver passes tests/contract.

Constructors are pure; `connect` opens, `close` shuts and stops the wheels. Listeners are called in the event
loop's thread, in order, and must return within about a millisecond. Commands never block.
"""

from collections.abc import Callable
from typing import Protocol

from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import ArmPose, ArmState, Frame, Health, Odometry, Twist

Unsubscribe = Callable[[], None]
"""Call it to stop hearing; calling it twice does no harm."""


class Base(Protocol):
    """Two driven wheels."""

    def drive(self, twist: Twist) -> Twist:
        """Send a twist now and return what was really sent, after the driver's limits.

        The base stops by itself when no call arrives for its own deadman time (150 ms).
        Raises LinkLost when there is nobody to send to.
        """
        ...

    def subscribe(self, listener: Callable[[Odometry], None]) -> Unsubscribe:
        """Hear every odometry reading (50 to 100 Hz)."""
        ...


class Arm(Protocol):
    """Four servos: A, B, C and the claw D."""

    def move(self, target: ArmPose) -> ArmPose:
        """Send the arm to `target` at its servos' speed and return the target after joint limits.

        The arm holds its pose when the host falls silent. Raises LinkLost.
        """
        ...

    def subscribe(self, listener: Callable[[ArmState], None]) -> Unsubscribe:
        """Hear every arm state (10 Hz or more)."""
        ...


class FrameSource(Protocol):
    """The camera. Frames are numbered from 1 and arrive as JPEG; newest wins, some may be missing."""

    def subscribe(self, listener: Callable[[Frame], None]) -> Unsubscribe:
        """Hear every frame that reaches the host."""
        ...


class Robot(Protocol):
    """A robot: description, parts, health."""

    @property
    def description(self) -> RobotDescription:
        """The robot file, validated."""
        ...

    @property
    def base(self) -> Base:
        """The wheels."""
        ...

    @property
    def arm(self) -> Arm:
        """The servos."""
        ...

    @property
    def frames(self) -> FrameSource:
        """The camera."""
        ...

    @property
    def health(self) -> Health:
        """Present state; also told to `subscribe_health` listeners when it changes."""
        ...

    def subscribe_health(self, listener: Callable[[Health], None]) -> Unsubscribe:
        """Hear every change of health."""
        ...

    async def connect(self) -> None:
        """Open ports, processes, cameras. Raises DriverError or SetupError with what to do."""
        ...

    async def close(self) -> None:
        """Stop the wheels and let go of everything. Safe to call twice."""
        ...


class Listeners:
    """A list of listeners of one kind of value; the part that every driver shares."""

    def __init__(self) -> None:
        self._listeners: list[Callable[..., None]] = []

    def subscribe(self, listener: Callable[..., None]) -> Unsubscribe:
        """Add a listener; the returned function takes it away again."""
        self._listeners.append(listener)

        def unsubscribe() -> None:
            if listener in self._listeners:
                self._listeners.remove(listener)

        return unsubscribe

    def tell(self, value: object) -> None:
        """Call every listener with `value`, in the order of subscription."""
        for listener in tuple(self._listeners):
            listener(value)
