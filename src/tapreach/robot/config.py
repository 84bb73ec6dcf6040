"""The robot file (`robots/*.toml`), validated. Lengths in metres; angles a person types in degrees."""

from math import radians
from pathlib import Path
from typing import Literal

from pydantic import Field, field_validator, model_validator
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.geometry.arm_clearance import BodyBox
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.pose import camera_mount
from tapreach.robot.arm_section import ArmSection
from tapreach.robot.camera_source import KNOWN_SOURCES, parse_source
from tapreach.robot.link_section import LinkSection
from tapreach.robot.section import Finite, Positive, RangeM, Section
from tapreach.robot.toml_file import PlacedValueError, load_validated


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
    """The camera: source, picture, lens, time."""

    source: str | None = Field(
        None,
        description="where the pictures come from: " + KNOWN_SOURCES.replace('"', "'") + "; left out where "
        "the driver has a camera of its own (sim, fake)",
    )
    width: int = Field(640, ge=160, le=4096)
    height: int = Field(480, ge=120, le=4096)
    rate_hz: Positive = 30.0
    fx: Positive = Field(description="focal length in pixels of this picture size")
    fy: Positive | None = Field(None, description="as fx when left out")
    cx: Finite | None = Field(None, description="the middle of the picture when left out")
    cy: Finite | None = None
    distortion: tuple[Finite, Finite, Finite, Finite, Finite] = (0.0, 0.0, 0.0, 0.0, 0.0)
    delay_ms: float = Field(
        0.0,
        ge=0,
        description="from the middle of the exposure to arrival on the host (v4l2: to the time stamp of the "
        "camera's driver), as far as known: the driver "
        "takes it off the times of pictures; what is left the robot measures by itself",
    )
    timing_sigma_ms: float = Field(
        4.0,
        ge=0,
        description="how far a picture's time may be off against the wheels', one sigma; from 2 ms on it is "
        "measured at the first locating",
    )
    keeps_settings: bool = Field(
        False,
        description="v4l2: exposure, gain, white balance and focus that were set by hand stay so; else what "
        "the camera has automatic of itself is switched on at opening",
    )
    mount: MountSection

    @field_validator("source")
    @classmethod
    def _names_a_known_source(cls, source: str | None) -> str | None:
        try:
            if source is not None:
                parse_source(source)
        except InputError as error:
            raise ValueError(str(error)) from None
        return source

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
    outline: tuple[tuple[Finite, Finite], ...] = Field(
        (),
        description="corners of the whole robot seen from above, x ahead and y left of the middle between "
        "the wheels [m]; left out, it reaches around wheels and [[body]], and without [[body]] 0.10 m ahead "
        "and 0.15 m back",
    )


class BodyBoxSection(Section):
    """A part of the base that the arm keeps clear of: from and to along each axis of the base frame [m]."""

    name: str = Field(min_length=1, description="as messages call it: 'chassis', 'camera'")
    x: RangeM
    y: RangeM
    z: RangeM

    def box(self) -> BodyBox:
        """Return it by its corners."""
        low, high = zip(self.x, self.y, self.z, strict=True)
        return BodyBox(self.name, low, high)

    @model_validator(mode="after")
    def _has_a_size(self) -> "BodyBoxSection":
        try:
            self.box()
        except InputError as error:
            raise ValueError(str(error)) from None
        return self


class RobotDescription(Section):
    """A whole robot file."""

    name: str = Field(min_length=1)
    driver: Literal["arduino", "fake", "sim"]
    camera: CameraSection
    base: BaseSection
    arm: ArmSection
    body: tuple[BodyBoxSection, ...] = Field(
        (), description="what the arm keeps clear of besides the floor, as [[body]]"
    )
    simulation: dict[str, object] = Field(
        default_factory=dict, description="scene and faults; see drivers/sim"
    )
    link: LinkSection | None = Field(None, description="the board of driver 'arduino'")

    @model_validator(mode="after")
    def _has_what_its_driver_needs(self) -> "RobotDescription":
        if self.driver == "arduino":
            if self.link is None:
                raise ValueError("driver 'arduino' needs the table [link] with the key address")
            if self.arm.servos is None:
                raise PlacedValueError("driver 'arduino' needs the tables [arm.servos.*]", "arm")
        elif self.link is not None:
            raise PlacedValueError(f"driver {self.driver!r} has no [link]: only 'arduino' has", "link")
        return self


def load_robot(path: Path) -> RobotDescription:
    """Read and validate a robot file. Raises ConfigError naming file, line and the known keys."""
    return load_validated(path, RobotDescription)
