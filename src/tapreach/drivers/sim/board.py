"""The simulated board: what the firmware of a real one does with twists, ticks and servo pulses.

It knows time only as the number of its own control periods, as a microcontroller does.
"""

import math
from dataclasses import dataclass

from tapreach.robot.config import BaseSection
from tapreach.robot.messages import STILL, Twist

CONTROL_PERIOD_S = 0.01
DEADMAN_S = 0.150
SUPPLY_VOLT = 6.0
_NO_LOAD_SPEED = 17.0
_FRICTION_VOLT = 0.12


@dataclass
class WheelControl:
    """Speed control of one wheel on encoder ticks: feed-forward and PI with a filtered speed.

    Gains in volt per rad/s and per rad; the integral is held when the voltage is at its limit.
    """

    proportional: float = 0.4
    integral: float = 8.0
    _sum: float = 0.0
    _speed: float = 0.0

    def volt(self, wanted: float, measured: float) -> float:
        """Return the motor voltage for a wanted and a measured speed [rad/s], once a control period."""
        self._speed += 0.35 * (measured - self._speed)
        if wanted == 0.0:
            self._sum = 0.0
            return 0.0
        error = wanted - self._speed
        ahead = wanted * SUPPLY_VOLT / _NO_LOAD_SPEED + math.copysign(_FRICTION_VOLT, wanted)
        volt = ahead + self.proportional * error + self._sum
        if abs(volt) < SUPPLY_VOLT:
            self._sum += self.integral * error * CONTROL_PERIOD_S
        return max(-SUPPLY_VOLT, min(SUPPLY_VOLT, volt))


class DriveBoard:
    """Twist in, motor voltages out, with limits and a deadman of its own.

    The wheels stop when no command came for 150 ms; then they move again only after a zero command.
    Accelerations are limited here, since a step in speed would only make the wheels spin.
    """

    def __init__(self, config: BaseSection) -> None:
        self._config = config
        self._left, self._right = WheelControl(), WheelControl()
        self._silence_s = math.inf
        self._asked = STILL
        self._ramped = STILL
        self._last_ticks: tuple[int, int] | None = None
        self.needs_zero = False

    def command(self, twist: Twist) -> None:
        """Take a command from the host; one that is not finite counts as zero."""
        self._silence_s = 0.0
        if twist.is_zero or not (math.isfinite(twist.linear) and math.isfinite(twist.angular)):
            self.needs_zero = False
            self._asked = STILL
        elif not self.needs_zero:
            self._asked = self._limited(twist)

    def control(self, ticks: tuple[int, int]) -> tuple[float, float]:
        """Return the voltages of the left and right motor; call once every control period."""
        self._silence_s += CONTROL_PERIOD_S
        if self._silence_s > DEADMAN_S and not self._asked.is_zero:
            self.needs_zero = True
            self._asked = self._ramped = STILL
        self._ramp()
        speeds = self._wheel_speeds(ticks)
        wanted = self._wanted_speeds()
        return self._left.volt(wanted[0], speeds[0]), self._right.volt(wanted[1], speeds[1])

    def _limited(self, twist: Twist) -> Twist:
        c = self._config
        return Twist(
            max(-c.max_linear, min(c.max_linear, twist.linear)),
            max(-c.max_angular, min(c.max_angular, twist.angular)),
        )

    def _ramp(self) -> None:
        """Approach the asked twist at the allowed accelerations; a stop is not delayed."""
        if self._asked.is_zero:
            self._ramped = STILL
            return
        dv = self._config.max_linear_acceleration * CONTROL_PERIOD_S
        dw = self._config.max_angular_acceleration * CONTROL_PERIOD_S
        now, ask = self._ramped, self._asked
        self._ramped = Twist(
            now.linear + max(-dv, min(dv, ask.linear - now.linear)),
            now.angular + max(-dw, min(dw, ask.angular - now.angular)),
        )

    def _wanted_speeds(self) -> tuple[float, float]:
        lead = 0.5 * self._config.track_width * self._ramped.angular
        radius = self._config.wheel_radius
        return (self._ramped.linear - lead) / radius, (self._ramped.linear + lead) / radius

    def _wheel_speeds(self, ticks: tuple[int, int]) -> tuple[float, float]:
        last = self._last_ticks or ticks
        self._last_ticks = ticks
        scale = 2 * math.pi / self._config.ticks_per_turn / CONTROL_PERIOD_S
        return (ticks[0] - last[0]) * scale, (ticks[1] - last[1]) * scale


@dataclass
class Servo:
    """A hobby servo as the board drives it: pulses of finite resolution, slewed at a limited speed.

    What the board can tell is where it sends the servo; backlash and a horn set off are unknown to it.
    """

    speed: float
    resolution: float
    position: float
    offset: float = 0.0
    backlash: float = 0.0
    target: float = math.nan
    _shaft: float = math.nan

    def __post_init__(self) -> None:
        self.target = self.position
        self._shaft = self.position

    @property
    def is_moving(self) -> bool:
        """True while the pulses are still on their way to the target."""
        return abs(self.target - self.position) > 1e-9

    def step(self, period_s: float) -> float:
        """Advance by one period and return the angle that the gear really asks of the joint."""
        most = self.speed * period_s
        self.position += max(-most, min(most, self.target - self.position))
        pulse = round(self.position / self.resolution) * self.resolution if self.resolution else self.position
        play = self.backlash / 2
        self._shaft = max(pulse - play, min(pulse + play, self._shaft))
        return self._shaft + self.offset
