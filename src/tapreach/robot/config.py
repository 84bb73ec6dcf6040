"""The robot file (`robots/*.toml`), validated. Lengths in metres; angles a person types in degrees."""

from math import radians
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pose import camera_mount
from tapreach.robot.messages import ArmPose
from tapreach.robot.toml_file import load_validated

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
RangeDeg = tuple[Finite, Finite]


class Section(BaseModel):
    """A table of a file that people write: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class MountSection(Section):
    """Where the camera sits on the base: projection centre [m] and angles."""

    forward: Finite = Field(description="ahead of the wheel axis, the rotation axis of the base [m]")
    left: Finite = 0.0
    up: Positive = Field(description="above the floor [m]")
    pitch_deg: Finite = Field(0.0, description="positive looks down")
    yaw_deg: Finite = Field(0.0, description="positive looks left")
    roll_deg: Finite = Field(0.0, description="positive leans right (clockwise seen from behind)")
    position_sigma: Positive = Field(0.005, description="one sigma of each coordinate [m]")
    angle_sigma_deg: Positive = Field(1.0, description="one sigma of each angle")

    def base_from_camera(self) -> RigidTransform:
        """Return the camera's pose on the base."""
        position_in_base = (self.forward, self.left, self.up)
        return camera_mount(
            position_in_base, radians(self.pitch_deg), radians(self.yaw_deg), radians(self.roll_deg)
        )


class CameraSection(Section):
    """The camera: picture, lens, time."""

    width: int = Field(640, ge=160, le=4096)
    height: int = Field(480, ge=120, le=4096)
    rate_hz: Positive = 30.0
    fx: Positive = Field(description="focal length in pixels of this picture size")
    fy: Positive | None = Field(None, description="as fx when left out")
    cx: Finite | None = Field(None, description="the middle of the picture when left out")
    cy: Finite | None = None
    distortion: tuple[Finite, Finite, Finite, Finite, Finite] = (0.0, 0.0, 0.0, 0.0, 0.0)
    delay_ms: float = Field(0.0, ge=0, description="from the middle of the exposure to arrival on the host")
    timing_sigma_ms: float = Field(
        4.0, ge=0, description="how far a picture's time may be off against the wheels', one sigma"
    )
    mount: MountSection

    def model(self) -> Camera:
        """Return the lens model."""
        size = ImageSize(self.width, self.height)
        return Camera(
            size=size,
            fx=self.fx,
            fy=self.fx if self.fy is None else self.fy,
            cx=(size.width - 1) / 2 if self.cx is None else self.cx,
            cy=(size.height - 1) / 2 if self.cy is None else self.cy,
            distortion=self.distortion,
        )


class BaseSection(Section):
    """Wheels, encoders, limits and how far the odometry is to be trusted."""

    wheel_radius: Positive
    track_width: Positive = Field(description="effective distance between the wheels' contact lines [m]")
    ticks_per_turn: Positive
    max_linear: Positive = Field(0.35, description="[m/s]")
    max_angular: Positive = Field(1.5, description="[rad/s]")
    max_linear_acceleration: Positive = Field(0.8, description="[m/s²]")
    max_angular_acceleration: Positive = Field(4.0, description="[rad/s²]")
    distance_sigma: Positive = Field(0.01, description="one sigma of the scale of all advances")
    turn_sigma: Positive = Field(0.01, description="one sigma of the scale of all turns")
    drift_sigma_deg_per_m: Positive = Field(0.5, description="one sigma of the heading per metre driven")
    distance_sigma_per_sqrt_m: Positive = Field(
        0.01, description="what is random in an advance: one sigma after 1 m, growing with the root [m]"
    )
    turn_sigma_deg_per_sqrt_rad: Positive = Field(
        0.6, description="what is random in a turn: one sigma after 1 rad, growing with the root"
    )
    sideways_sigma_per_sqrt_m: Positive = Field(
        0.005, description="sliding sideways in an advance: one sigma after 1 m, growing with the root [m]"
    )
    creep_sigma_per_rad: float = Field(
        0.005, ge=0, description="how far it moves ahead or sideways while it turns on the spot [m/rad]"
    )


class ArmPoseSection(Section):
    """A pose of the arm by its servos."""

    rotation_deg: Finite = 0.0
    shoulder_deg: Finite
    elbow_deg: Finite
    claw: float = Field(ge=0, description="opening [m]")

    def pose(self) -> ArmPose:
        """Return it in radians."""
        return ArmPose(
            radians(self.rotation_deg), radians(self.shoulder_deg), radians(self.elbow_deg), self.claw
        )


class ArmSection(Section):
    """The paper's arm: A turns it, B and C move it in a plane, a linkage keeps it level, D is the claw."""

    shoulder_forward: Finite = Field(description="axis of B ahead of the wheel axis [m]; on the axis of A")
    shoulder_left: Finite = Field(0.0, description="axis of A left of the middle [m]")
    shoulder_up: Positive = Field(description="axis of B above the floor [m]")
    upper_length: Positive = Field(description="axis of B to axis of C [m]")
    fore_length: Positive = Field(description="axis of C to the wrist [m]")
    hand_length: Positive = Field(description="wrist to the middle between the finger tips [m]")
    claw_max: Positive = Field(description="widest opening [m]")
    rotation_limits_deg: RangeDeg
    shoulder_limits_deg: RangeDeg
    elbow_limits_deg: RangeDeg
    speed_deg_s: Positive = Field(140.0, description="fastest servo speed")
    standard: ArmPoseSection = Field(description="pose for locating: out of the picture")
    stowed: ArmPoseSection = Field(description="pose for driving")


class RobotDescription(Section):
    """A whole robot file."""

    name: str = Field(min_length=1)
    driver: Literal["sim", "fake"]
    camera: CameraSection
    base: BaseSection
    arm: ArmSection
    simulation: dict[str, object] = Field(
        default_factory=dict, description="scene and faults; see drivers/sim"
    )


def load_robot(path: Path) -> RobotDescription:
    """Read and validate a robot file. Raises ConfigError naming file, line and the known keys."""
    return load_validated(path, RobotDescription)
