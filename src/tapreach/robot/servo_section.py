"""[arm.servos] of the robot file: which pulse puts each servo where."""

from typing import Self

from pydantic import Field, model_validator

from tapreach.robot.section import Positive, Section

SHORTEST_US, LONGEST_US = 500, 2500
_ZERO = "pulse at which the joint stands at 0 [µs]; may lie outside the servo's limits"


class _Servo(Section):
    pulse_at_zero_us: float = Field(ge=-2000, le=5000, description=_ZERO)
    reversed: bool = Field(False, description="a longer pulse moves the joint to smaller values")
    low_us: int = Field(
        ge=SHORTEST_US, le=LONGEST_US, description="shortest pulse; the firmware holds it too"
    )
    high_us: int = Field(ge=SHORTEST_US, le=LONGEST_US, description="longest pulse")

    @model_validator(mode="after")
    def _limits_are_in_order(self) -> Self:
        if self.low_us >= self.high_us:
            raise ValueError(f"low_us {self.low_us} must be below high_us {self.high_us}")
        return self


class ServoSection(_Servo):
    """A servo that turns a joint."""

    us_per_deg: Positive = Field(10.0, description="how much longer a pulse turns by one degree [µs]")


class ClawServoSection(_Servo):
    """The servo of the claw: closed is 0, opening counts in millimetres between the fingers."""

    us_per_mm: Positive = Field(description="how much longer a pulse opens by one millimetre [µs]")


class ServosSection(Section):
    """Servos A, B, C and D, in the order of the board's outputs."""

    rotation: ServoSection
    shoulder: ServoSection
    elbow: ServoSection
    claw: ClawServoSection
