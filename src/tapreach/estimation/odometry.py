"""Wheel odometry of a differential drive: encoder counts to a pose on the floor.

Source: Thrun, Burgard and Fox, Probabilistic Robotics, 5.4; the arc is integrated exactly.
"""

import math
from dataclasses import dataclass

from tapreach.errors import InputError
from tapreach.geometry.finite import positive
from tapreach.geometry.planar_motion import PlanarPose

_COUNTER_RANGE = 2**32


@dataclass(frozen=True)
class OdometryReading:
    """Where the wheels say the base is, and how it moved since the reading before.

    pose: world_from_base. speed [m/s] forward, turn_rate [rad/s] to the left: means since the last reading.
    """

    captured_ns: int
    pose: PlanarPose
    speed: float
    turn_rate: float


class WheelOdometry:
    """Integrates the running tick counts of two wheels.

    wheel_radius, track_width [m]: effective values from calibration; the track is the distance between the
    lines the wheels roll on. ticks_per_turn: counts per turn of a wheel. All above zero, else InputError.
    """

    def __init__(
        self,
        wheel_radius: float,
        track_width: float,
        ticks_per_turn: float,
        start: PlanarPose | None = None,
    ) -> None:
        circumference = 2.0 * math.pi * positive("wheel_radius", wheel_radius)
        self._metres_per_tick = circumference / positive("ticks_per_turn", ticks_per_turn)
        self._track_width = positive("track_width", track_width)
        self._reading = OdometryReading(0, start if start is not None else PlanarPose(), 0.0, 0.0)
        self._ticks: tuple[int, int] | None = None

    @property
    def reading(self) -> OdometryReading:
        """The newest reading; at the start pose and time 0 before the first update."""
        return self._reading

    def update(self, left_ticks: int, right_ticks: int, captured_ns: int) -> OdometryReading:
        """Take running counts, read at `captured_ns`, and return the new reading.

        The first call sets the counts to start from. Counts may wrap at 32 bits. Raises InputError, and
        leaves everything as it was, where the time goes backwards or stands while the wheels moved.
        """
        before = self._ticks if self._ticks is not None else (left_ticks, right_ticks)
        left = _moved(before[0], left_ticks) * self._metres_per_tick
        right = _moved(before[1], right_ticks) * self._metres_per_tick
        elapsed = self._elapsed(captured_ns)
        if elapsed == 0.0 and (left or right):
            raise InputError(f"wheels moved at captured_ns {captured_ns}, the time of the reading before")
        distance, turn = (left + right) / 2.0, (right - left) / self._track_width
        pose = self._reading.pose.after_arc(distance, turn)
        rate = 1.0 / elapsed if elapsed > 0.0 else 0.0
        self._reading = OdometryReading(captured_ns, pose, distance * rate, turn * rate)
        self._ticks = (left_ticks, right_ticks)
        return self._reading

    def _elapsed(self, captured_ns: int) -> float:
        if self._ticks is None:
            return 0.0
        if captured_ns < self._reading.captured_ns:
            raise InputError(
                f"captured_ns is {captured_ns}, before the last reading at {self._reading.captured_ns}; "
                f"readings must come in the order of time"
            )
        return (captured_ns - self._reading.captured_ns) * 1e-9


def _moved(before: int, after: int) -> int:
    half = _COUNTER_RANGE // 2
    return (after - before + half) % _COUNTER_RANGE - half
