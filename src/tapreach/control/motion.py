"""A motion that a task asked for, as the control loop sees it: senses in, twist out, until it has ended."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from tapreach.robot.messages import ArmState, Odometry, Twist


class Progress(StrEnum):
    """How far a motion is."""

    MOVING = "moving"
    ARRIVED = "arrived"
    GIVEN_UP = "given_up"


@dataclass(frozen=True, slots=True)
class Senses:
    """The newest readings; None before the first."""

    odometry: Odometry | None = None
    arm: ArmState | None = None


class Motion(Protocol):
    """One motion; used once."""

    moves_arm: bool
    """True when ending it early must also hold the arm."""

    @property
    def progress(self) -> Progress:
        """Whether it goes on."""
        ...

    @property
    def reason(self) -> str:
        """Why it was given up; '' otherwise."""
        ...

    def step(self, senses: Senses, now_ns: int) -> Twist | None:
        """Return the twist for the next period; zero once it has ended.

        None while the robot moves by itself: then no twist may be sent, for it would end that move.
        """
        ...
