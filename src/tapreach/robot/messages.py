"""Values that travel between driver, control, tasks and page. SI units, radians, monotonic ns."""

from dataclasses import dataclass
from enum import StrEnum

from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose


@dataclass(frozen=True, slots=True)
class Twist:
    """Speed of the base along its heading [m/s] and about its axis [rad/s, left positive]."""

    linear: float
    angular: float

    @property
    def is_zero(self) -> bool:
        """True when neither wheel is asked to turn."""
        return self.linear == 0.0 and self.angular == 0.0


STILL = Twist(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Odometry:
    """What the wheels say: pose since start-up, present speed, and path length driven so far [m]."""

    captured_ns: int
    world_from_base: PlanarPose
    twist: Twist
    distance: float


@dataclass(frozen=True, slots=True)
class ArmPose:
    """Joint angles [rad] of A (rotation), B (shoulder), C (elbow), and the opening of D, the claw [m].

    rotation: about z up, left positive, 0 straight ahead. shoulder: 0 upright, positive leans forward.
    elbow: angle of the forearm relative to the upper arm, positive bends down; 0 at a right angle
    (the forearm level when the upper arm is upright).
    """

    rotation: float
    shoulder: float
    elbow: float
    claw: float


@dataclass(frozen=True, slots=True)
class ArmState:
    """Where the arm is, as far as its servos tell, and where it was sent."""

    captured_ns: int
    pose: ArmPose
    target: ArmPose
    is_moving: bool


@dataclass(frozen=True, slots=True)
class Frame:
    """One picture. `captured_ns` is the middle of the exposure as the host believes it."""

    frame_id: int
    captured_ns: int
    received_ns: int
    size: ImageSize
    jpeg: bytes


class LinkStatus(StrEnum):
    """State of the robot as a whole."""

    STARTING = "starting"
    RUNNING = "running"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class Health:
    """Whether the robot can be used, and the sentence to show when not."""

    status: LinkStatus
    reason: str = ""

    @property
    def is_running(self) -> bool:
        """True when base, arm and camera answer."""
        return self.status is LinkStatus.RUNNING
