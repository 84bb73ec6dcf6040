"""What is wrong with the simulated robot. All zero is a robot that agrees with its file."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from tapreach.errors import ConfigError

Fraction = Annotated[float, Field(ge=-0.3, le=0.3, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0.0, le=0.9, allow_inf_nan=False)]
Amount = Annotated[float, Field(ge=0.0, le=1000.0, allow_inf_nan=False)]
Metres = Annotated[float, Field(ge=-0.1, le=0.1, allow_inf_nan=False)]
Degrees = Annotated[float, Field(ge=-30.0, le=30.0, allow_inf_nan=False)]


class SimFaults(BaseModel):
    """Each fault with its unit and sense. Set in a scene file, in a robot file, or on the command line."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    wheel_left_error: Fraction = Field(
        0.0,
        description="the left encoder counts this fraction too much: as a wheel smaller than its file says",
    )
    wheel_right_error: Fraction = Field(0.0, description="the same for the right wheel")
    track_error: Fraction = Field(0.0, description="the wheels stand this fraction wider than the file says")
    slip: Share = Field(0.0, description="fraction of each wheel's turning that does not move the robot")
    slip_noise: Share = Field(
        0.0,
        description="random slip of each wheel on its own: one sigma after 1 m of rolling, fraction [1/√m]",
    )
    encoder_ticks_per_turn: int | None = Field(
        None, ge=4, le=100_000, description="ticks of one wheel turn; as in the robot file when left out"
    )
    camera_delay_ms: Amount = Field(
        0.0, description="further delay of each picture, unknown to the host [ms]"
    )
    dropped_frames: Share = Field(0.0, description="probability that a picture is lost")
    jpeg_quality: int = Field(80, ge=1, le=100, description="quality of the camera's JPEG")
    exposure_noise: Share = Field(
        0.0,
        description="one sigma of the brightness from picture to picture (fraction) and of pixel noise (/10)",
    )
    motion_blur_ms: Annotated[float, Field(ge=0.0, le=100.0, allow_inf_nan=False)] = Field(
        0.0, description="exposure time; what moves meanwhile is blurred [ms]"
    )
    focal_error: Fraction = Field(
        0.0, description="the true focal length is this fraction longer than in the file"
    )
    mount_forward: Metres = Field(0.0, description="the camera truly sits this much further ahead [m]")
    mount_left: Metres = Field(0.0, description="... further left [m]")
    mount_up: Metres = Field(0.0, description="... higher [m]")
    mount_pitch_deg: Degrees = Field(0.0, description="... looks further down")
    mount_yaw_deg: Degrees = Field(0.0, description="... looks further left")
    mount_roll_deg: Degrees = Field(0.0, description="... leans further right")
    servo_offset_deg: Degrees = Field(0.0, description="the horns of A, B and C sit off by this angle")
    servo_backlash_deg: Annotated[float, Field(ge=0.0, le=10.0, allow_inf_nan=False)] = Field(
        0.6, description="play of the servos' gears, whole width"
    )

    def merged(self, overrides: Mapping[str, Any]) -> "SimFaults":
        """Return these faults with `overrides` in their place.

        Raises ConfigError for an unknown fault or an impossible value, naming the known ones.
        """
        try:
            return SimFaults.model_validate({**self.model_dump(exclude_unset=True), **overrides})
        except ValidationError as error:
            raise ConfigError("\n".join(map(_sentence, error.errors()))) from None


def _sentence(fault: Any) -> str:
    name = ".".join(str(part) for part in fault["loc"])
    if fault["type"] == "extra_forbidden":
        return f"fault {name!r} is not known; known faults: {', '.join(SimFaults.model_fields)}"
    return f"fault {name}: {fault['msg']} (given: {fault['input']!r})"
