"""Odometry from the running tick counts of a board."""

from collections import deque

from tapreach.estimation.odometry import WheelOdometry
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import Odometry, Twist

SPEED_WINDOW_NS = 100_000_000


class TickOdometry:
    """Turns ticks into odometry with the robot file's radius and track.

    Counts may wrap at 32 bits. `rebase` before counts that do not go on from those before.
    """

    def __init__(self, base: BaseSection) -> None:
        self._base = base
        self._wheels = WheelOdometry(base.wheel_radius, base.track_width, base.ticks_per_turn)
        self._distance = 0.0
        self._is_first = True
        self._recent: deque[tuple[int, float, float]] = deque()

    def update(self, captured_ns: int, left_ticks: int, right_ticks: int) -> Odometry:
        """Return the odometry now; speeds are means over 100 ms, since ticks are whole.

        Raises InputError where the time does not rise while the wheels moved.
        """
        before_ns = self._wheels.reading.captured_ns
        reading = self._wheels.update(left_ticks, right_ticks, captured_ns)
        if not self._is_first:
            advance = reading.speed * (reading.captured_ns - before_ns) * 1e-9
            self._distance += abs(advance)
            turn = reading.turn_rate * (reading.captured_ns - before_ns) * 1e-9
            self._recent.append((reading.captured_ns, advance, turn))
        self._is_first = False
        while self._recent and self._recent[0][0] <= reading.captured_ns - SPEED_WINDOW_NS:
            self._recent.popleft()
        return Odometry(reading.captured_ns, reading.pose, self._mean_twist(), self._distance)

    def rebase(self) -> None:
        """Go on from the pose reached, with counts that begin anew (the board restarted, or was away)."""
        base = self._base
        self._wheels = WheelOdometry(
            base.wheel_radius, base.track_width, base.ticks_per_turn, start=self._wheels.reading.pose
        )
        self._is_first = True
        self._recent.clear()

    def _mean_twist(self) -> Twist:
        span = SPEED_WINDOW_NS * 1e-9
        return Twist(sum(a for _, a, _ in self._recent) / span, sum(t for _, _, t in self._recent) / span)
