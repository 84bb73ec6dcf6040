"""What a lesson needs of a robot's board: wheels without feedback, ticks, and servos by their pulses.

A lesson finds out what the robot file has to say, so nothing here goes by it: no metres, no angles.
"""

from collections.abc import Awaitable, Callable
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

from tapreach.robot.config import RobotDescription
from tapreach.robot.own_moves import OwnMove

Side = Literal["left", "right"]
ServoIndex = Literal[0, 1, 2, 3]


class CarryOut(Protocol):
    """Carries out a small move under whatever watches over moves: the control loop, or a person alone."""

    def __call__(self, begin: Callable[[], OwnMove], moves_arm: bool = False) -> Awaitable[object]:
        """Begin a move, keep it until it has ended, and return once it has arrived.

        Raises TapreachError with the reason where it did not, or where it may not.
        """
        ...


@dataclass(frozen=True, slots=True)
class WheelTicks:
    """What the encoders have counted, each within 32 bits."""

    left: int
    right: int

    def since(self, before: "WheelTicks") -> dict[Side, int]:
        """Return the ticks that have come since; the count wraps at 32 bits."""
        return {"left": _wrapped(self.left - before.left), "right": _wrapped(self.right - before.right)}


class Bench(Protocol):
    """A board on the bench: small, slow, raw moves of one part at a time.

    What is awaited raises LinkLost when the board is out of reach, DriverError when it refuses, and what
    CarryOut raises.
    """

    @property
    def counts_turns(self) -> bool:
        """False where no encoder counts: steppers count their own micro steps."""
        ...

    def ticks(self) -> WheelTicks:
        """Return what the encoders have counted. Raises LinkLost, and DriverError where that cannot be."""
        ...

    async def pause(self, duration_ns: int) -> None:
        """Let time pass."""
        ...

    async def take_feedback_off(self) -> None:
        """From now on wheels turn slowly by power alone: an encoder counting backwards is harmless."""
        ...

    async def give_feedback_back(self) -> bool:
        """Stop the wheels, and control speeds as before; False where the board did not take it."""
        ...

    async def spin(self, side: Side) -> None:
        """Turn one wheel forward for a second, and return when it has come to rest."""
        ...

    def rest_us(self, index: ServoIndex) -> int:
        """Return the pulse of the stowed pose by the robot file [µs]."""
        ...

    async def limit_servo(self, index: ServoIndex, low_us: int, high_us: int) -> None:
        """Let a servo's pulse go from low_us to high_us [µs] for now; it must stand between them."""
        ...

    async def send_servo(self, index: ServoIndex, pulse_us: int) -> None:
        """Send one servo to a pulse [µs], slowly, and return when it is there."""
        ...


@runtime_checkable
class Teachable(Protocol):
    """What a robot also offers where its board can be taught while it is connected."""

    @property
    def can_be_taught(self) -> bool:
        """False where the board's firmware lacks what lessons need."""
        ...

    def taught(
        self, description: RobotDescription, carry_out: CarryOut
    ) -> AbstractAsyncContextManager[Bench]:
        """Enter a lesson that goes by `description`, the robot file as it is now.

        Meanwhile an arm that is sent to a pose holds instead, for its angles are not known. On leaving, the
        board is told again what it goes by, and no servo moves for that. Raises LinkLost, DriverError.
        """
        ...


def _wrapped(difference: int) -> int:
    return (difference + 2**31) % 2**32 - 2**31
