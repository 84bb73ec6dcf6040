"""Moves that a robot carries out by itself once told: exact, ramped, and stopped by silence all the same."""

from enum import StrEnum
from typing import Protocol, runtime_checkable

from tapreach.geometry.planar_motion import PlanarStep


class MoveStatus(StrEnum):
    """How a move stands."""

    MOVING = "moving"
    ARRIVED = "arrived"
    CANCELLED = "cancelled"
    FAILED = "failed"


class OwnMove(Protocol):
    """A move under way.

    It needs `keep` at least every 100 ms, as a control loop calls it: without that the robot's deadman
    stops the wheels. `Base.drive` while it moves cancels it; what was told last holds.
    """

    @property
    def status(self) -> MoveStatus:
        """How it stands."""
        ...

    @property
    def reason(self) -> str:
        """Why it failed or was cancelled; '' otherwise."""
        ...

    @property
    def fraction(self) -> float:
        """How much of it is done, 0 to 1."""
        ...

    def keep(self) -> None:
        """Say that it is still wanted. Nothing once it has ended. Raises LinkLost."""
        ...

    def cancel(self, reason: str = "cancelled") -> bool:
        """Stop the wheels now; False, and nothing, once it has ended. Moving again needs a zero first."""
        ...


@runtime_checkable
class MovesByItself(Protocol):
    """What a robot's base also offers where its board can move by itself."""

    @property
    def own_move(self) -> OwnMove | None:
        """The move that is under way; None while there is none."""
        ...

    def drive_by(self, step: PlanarStep, share: float = 1.0) -> OwnMove:
        """Begin a turn and an advance after it; what was done comes as odometry.

        share: of the speed that it usually takes for that. Raises LinkLost, or DriverError where the wheels
        cannot begin: a fault, another move, still turning.
        """
        ...
