"""Twists to wheel speeds and steps to wheel ways, in ticks, by the robot file."""

from math import hypot, tau

from tapreach.drivers.arduino.wire import Gains
from tapreach.drivers.limits import limited_twist
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import Twist

INT16, UINT16 = 32767, 65535
FIRMWARE_GAINS = Gains(20, 200, 0, 20, 4000, 8000)
"""Those the firmware starts with (control.h)."""
GENTLE = 0.5
"""Share of speed and acceleration that a move of the board's own uses: gentle driving slips less."""


class Wheels:
    """Two wheels of the same radius. Left turns are positive: the right wheel ahead, the left one back."""

    def __init__(self, base: BaseSection) -> None:
        self._base = base
        self.ticks_per_m = base.ticks_per_turn / (tau * base.wheel_radius)

    def limited(self, twist: Twist) -> Twist:
        """Return `twist` within the robot file's limits and what 16 bits of ticks/s can say."""
        allowed = limited_twist(twist, self._base)
        fastest = max(abs(speed) for speed in self._speeds(allowed))
        share = min(1.0, INT16 / fastest) if fastest > 0.0 else 1.0
        return Twist(allowed.linear * share, allowed.angular * share)

    def ticks_per_s(self, twist: Twist) -> tuple[int, int]:
        """Return the speeds of the left and the right wheel."""
        left, right = self._speeds(twist)
        return round(left), round(right)

    def twist(self, left: float, right: float) -> Twist:
        """Return the twist that wheel speeds [ticks/s] make."""
        linear = (left + right) / 2.0 / self.ticks_per_m
        return Twist(linear, (right - left) / self.ticks_per_m / self._base.track_width)

    def turn_ticks(self, step: PlanarStep) -> tuple[int, int]:
        """Return the ways of both wheels [ticks] for the step's turn on the spot."""
        way = round(step.turn * self._base.track_width / 2.0 * self.ticks_per_m)
        return -way, way

    def advance_ticks(self, step: PlanarStep) -> tuple[int, int]:
        """Return the ways of both wheels [ticks] for the step's advance."""
        way = round(step.advance * self.ticks_per_m)
        return way, way

    def turn_rates(self, share: float = 1.0) -> tuple[int, int]:
        """Return speed [ticks/s] and acceleration [ticks/s²] of a wheel in a gentle turn on the spot."""
        arm = self._base.track_width / 2.0
        return self._rates(share * self._base.max_angular * arm, self._base.max_angular_acceleration * arm)

    def advance_rates(self, share: float = 1.0) -> tuple[int, int]:
        """Return speed [ticks/s] and acceleration [ticks/s²] of a wheel in a gentle advance."""
        return self._rates(share * self._base.max_linear, self._base.max_linear_acceleration)

    @property
    def fastest(self) -> int:
        """Return the speed of a wheel that no allowed twist exceeds [ticks/s]."""
        arm = self._base.track_width / 2.0
        return min(INT16, round(self.ticks_per_m * (self._base.max_linear + arm * self._base.max_angular)))

    @property
    def quickest(self) -> int:
        """Return the acceleration of a wheel that no allowed change of twist exceeds [ticks/s²]."""
        base, arm = self._base, self._base.track_width / 2.0
        most = base.max_linear_acceleration + arm * base.max_angular_acceleration
        return min(UINT16, round(self.ticks_per_m * most))

    def eased(self, before: Twist, wanted: Twist, duration: float) -> Twist:
        """Return the twist on the straight way from `before` to `wanted` that is reached in `duration` [s].

        Both accelerations keep to the robot file's limits. Braking is not eased: zero is at once.
        """
        if wanted.is_zero:
            return wanted
        linear, angular = wanted.linear - before.linear, wanted.angular - before.angular
        needed = hypot(
            linear / self._base.max_linear_acceleration, angular / self._base.max_angular_acceleration
        )
        share = min(1.0, duration / needed) if needed > 0.0 else 1.0
        return Twist(before.linear + share * linear, before.angular + share * angular)

    def _speeds(self, twist: Twist) -> tuple[float, float]:
        difference = twist.angular * self._base.track_width / 2.0
        return (twist.linear - difference) * self.ticks_per_m, (twist.linear + difference) * self.ticks_per_m

    def _rates(self, speed: float, acceleration: float) -> tuple[int, int]:
        per_s, per_s2 = (max(1, round(GENTLE * self.ticks_per_m * v)) for v in (speed, acceleration))
        return min(INT16, per_s), min(UINT16, per_s2)
