"""Joint angles to servo pulses and back, by the robot file."""

from dataclasses import dataclass
from math import degrees

from tapreach.drivers.limits import limited_arm
from tapreach.errors import ConfigError
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.messages import ArmPose
from tapreach.robot.servo_section import ClawServoSection, ServoSection

Four = tuple[float, float, float, float]
Pulses = tuple[int, int, int, int]
CLAW_TRAVEL_DEG = 70.0
"""What a claw's servo turns from closed to open: it opens as fast as the others turn."""
UINT16 = 65535


@dataclass(frozen=True, slots=True)
class Servo:
    """pulse = zero_us + us_per_unit · value, within low_us and high_us; the sign is the direction.

    value: [rad], for the claw [m].
    """

    zero_us: float
    us_per_unit: float
    low_us: int
    high_us: int

    def pulse_us(self, value: float) -> int:
        """Return the pulse that is nearest to `value`, within the limits."""
        wanted = self.zero_us + self.us_per_unit * value
        return round(max(self.low_us, min(self.high_us, wanted)))

    def value(self, pulse_us: float) -> float:
        """Return where this pulse puts the joint."""
        return (pulse_us - self.zero_us) / self.us_per_unit

    def limited(self, value: float) -> float:
        """Return `value`, or the nearest that a pulse within the limits reaches."""
        ends = sorted((self.value(self.low_us), self.value(self.high_us)))
        return max(ends[0], min(ends[1], value))


class ServoMap:
    """The four servos of an arm. Raises ConfigError where the robot file has no [arm.servos]."""

    def __init__(self, arm: ArmSection) -> None:
        if arm.servos is None:
            raise ConfigError(
                "the robot file has no [arm.servos]: without it no pulse is known for any angle"
            )
        self._arm = arm
        turning = (arm.servos.rotation, arm.servos.shoulder, arm.servos.elbow)
        self.servos = (*(_joint_servo(s) for s in turning), _claw_servo(arm.servos.claw))

    def limited(self, pose: ArmPose) -> ArmPose:
        """Return `pose` within the joints' limits and the servos'."""
        wanted = values_of(limited_arm(pose, self._arm))
        return ArmPose(*(s.limited(v) for s, v in zip(self.servos, wanted, strict=True)))

    def pulses_us(self, pose: ArmPose) -> Pulses:
        """Return the pulses for A, B, C and D, within their limits."""
        a, b, c, d = (s.pulse_us(v) for s, v in zip(self.servos, values_of(pose), strict=True))
        return a, b, c, d

    def pose(self, pulses_us: Four | Pulses) -> ArmPose:
        """Return the pose that these pulses make; where one is 0 (never sent) the joint counts as stowed."""
        stowed = values_of(self._arm.stowed.pose())
        given = zip(self.servos, pulses_us, stowed, strict=True)
        return ArmPose(*(servo.value(pulse) if pulse else rest for servo, pulse, rest in given))

    def speeds_us_per_s(self) -> Pulses:
        """Return the speed limits of A, B, C and D from the robot file's speed_deg_s."""
        turn = self._arm.joint_speed
        opening = self._arm.claw_max * self._arm.speed_deg_s / CLAW_TRAVEL_DEG
        wanted = (turn, turn, turn, opening)
        pairs = zip(self.servos, wanted, strict=True)
        a, b, c, d = (max(1, min(UINT16, round(abs(s.us_per_unit) * v))) for s, v in pairs)
        return a, b, c, d


def values_of(pose: ArmPose) -> Four:
    """Return rotation, shoulder, elbow [rad] and claw [m]."""
    return pose.rotation, pose.shoulder, pose.elbow, pose.claw


def _joint_servo(section: ServoSection) -> Servo:
    per_rad = section.us_per_deg * degrees(1.0)
    sign = -1.0 if section.reversed else 1.0
    return Servo(section.pulse_at_zero_us, sign * per_rad, section.low_us, section.high_us)


def _claw_servo(section: ClawServoSection) -> Servo:
    sign = -1.0 if section.reversed else 1.0
    return Servo(section.pulse_at_zero_us, sign * section.us_per_mm * 1000.0, section.low_us, section.high_us)
