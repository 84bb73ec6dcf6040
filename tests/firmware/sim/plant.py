"""A drive base behind a motor driver: two geared motors, and where the base gets to on a flat floor."""

import math
from dataclasses import dataclass, field
from typing import Protocol


class Plant(Protocol):
    """What the firmware moves."""

    def step(self, duties: tuple[float, float], seconds: float) -> None:
        """Apply the duties [-1, 1], left and right, for so long."""
        ...

    @property
    def angles(self) -> tuple[float, float]:
        """Of the wheels [rad], left and right."""
        ...

    @property
    def pose(self) -> tuple[float, float, float]:
        """Of the base on the floor: x [m], y [m], heading [rad], turns counted."""
        ...


@dataclass(frozen=True)
class Motor:
    """A geared motor with its share of the mass; it stands still below `breakaway`, as brushes stick."""

    free_speed: float = 17.0
    """[rad/s] at full duty."""
    time_constant: float = 0.08
    """[s]"""
    breakaway: float = 0.12
    """Duty below which it does not start."""
    drag: float = 0.06
    """Duty that friction takes while it turns."""

    def after(self, speed: float, duty: float, seconds: float) -> float:
        """Return the speed [rad/s] a moment later."""
        if abs(speed) < 0.05 and abs(duty) < self.breakaway:
            return 0.0
        against = math.copysign(self.drag, speed if abs(speed) >= 0.05 else duty)
        ending = self.free_speed * (duty - against)
        return ending + (speed - ending) * math.exp(-seconds / self.time_constant)


@dataclass
class DrivePlant:
    """Two motors and the wheels' geometry [m], without slip. Not the same on both sides, as none are."""

    wheel_radius: float = 0.033
    track_width: float = 0.169
    motors: tuple[Motor, Motor] = (Motor(), Motor(free_speed=16.2, time_constant=0.09, breakaway=0.14))
    speeds: list[float] = field(default_factory=lambda: [0.0, 0.0])
    turned: list[float] = field(default_factory=lambda: [0.0, 0.0])
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def step(self, duties: tuple[float, float], seconds: float) -> None:
        """See Plant."""
        rolled = []
        for side in (0, 1):
            after = self.motors[side].after(self.speeds[side], duties[side], seconds)
            angle = (self.speeds[side] + after) / 2 * seconds
            self.speeds[side] = after
            self.turned[side] += angle
            rolled.append(angle * self.wheel_radius)
        self._move((rolled[0] + rolled[1]) / 2, (rolled[1] - rolled[0]) / self.track_width)

    def _move(self, advance: float, turn: float) -> None:
        x, y, heading = self.at
        along = heading + turn / 2
        self.at = (x + advance * math.cos(along), y + advance * math.sin(along), heading + turn)

    @property
    def angles(self) -> tuple[float, float]:
        """See Plant."""
        return self.turned[0], self.turned[1]

    @property
    def pose(self) -> tuple[float, float, float]:
        """See Plant."""
        return self.at
