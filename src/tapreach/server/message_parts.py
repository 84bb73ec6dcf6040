"""What stands inside messages of the control socket: speeds, lens, odometry, arm, lease, size of a target."""

from pydantic import Field

from tapreach.server.message_base import Message


class TwistView(Message):
    """Speeds [m/s], [rad/s]."""

    linear: float
    angular: float


class CameraView(Message):
    """Lens and mount, for drawing."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    pitch_deg: float
    rate_hz: float


class OdometryView(Message):
    """Odometry in the world frame."""

    x: float
    y: float
    heading_deg: float
    distance: float
    linear: float
    angular: float


class ArmView(Message):
    """Servo angles as a person reads them."""

    rotation_deg: float
    shoulder_deg: float
    elbow_deg: float
    claw_mm: float
    is_moving: bool


class LeaseView(Message):
    """Who drives."""

    holder_id: int | None
    holder_name: str
    is_idle: bool
    asked_by_id: int | None
    asked_by_name: str


class ExtentView(Message):
    """How large a boxed target is, in the upright plane that faced the camera [m]; null: not known."""

    width: float | None
    height: float | None
    width_sigma: float | None = Field(description="one sigma, of the width")
    height_sigma: float | None = Field(description="one sigma, of the height")
    reason: str = Field(description="why there is no size, or what to know of it")
