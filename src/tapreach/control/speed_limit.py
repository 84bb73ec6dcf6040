"""How fast, and how fast to get there."""

from dataclasses import dataclass

from tapreach.robot.config import BaseSection
from tapreach.robot.messages import Twist


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Largest speeds [m/s, rad/s] and accelerations [m/s², rad/s²]; all above zero."""

    linear: float
    angular: float
    linear_acceleration: float
    angular_acceleration: float

    @classmethod
    def of(cls, base: BaseSection) -> "SpeedLimits":
        """Return the limits of a robot file."""
        return cls(
            base.max_linear, base.max_angular, base.max_linear_acceleration, base.max_angular_acceleration
        )


def limited(twist: Twist, limits: SpeedLimits) -> Twist:
    """Return `twist`, made slower as a whole where it is too fast, so that the path keeps its bend."""
    factor = max(1.0, abs(twist.linear) / limits.linear, abs(twist.angular) / limits.angular)
    return Twist(
        _clipped(twist.linear / factor, limits.linear), _clipped(twist.angular / factor, limits.angular)
    )


def ramped(previous: Twist, wanted: Twist, duration: float, limits: SpeedLimits) -> Twist:
    """Return the twist to send `duration` [s] after `previous`: speeding up is ramped, slowing down is not.

    A reversal passes through zero. Holds `wanted` as it is where that needs no speeding up.
    """
    return Twist(
        _approach(previous.linear, wanted.linear, limits.linear_acceleration * duration),
        _approach(previous.angular, wanted.angular, limits.angular_acceleration * duration),
    )


def _approach(previous: float, wanted: float, step: float) -> float:
    start = abs(previous) if previous * wanted > 0.0 else 0.0
    return _clipped(wanted, start + step)


def _clipped(value: float, most: float) -> float:
    return max(-most, min(most, value))
