"""The robot file of the pattern robot."""

from tapreach.geometry.pixel import ImageSize
from tapreach.robot.arm_section import ArmPoseSection, ArmSection
from tapreach.robot.config import (
    BaseSection,
    CameraSection,
    MountSection,
    RobotDescription,
)


def pattern_description(size: ImageSize, rate_hz: float) -> RobotDescription:
    """Return a robot file's content for pictures of `size` at `rate_hz`."""
    standard = ArmPoseSection(rotation_deg=0, shoulder_deg=-40, elbow_deg=40, claw=0.05)
    return RobotDescription(
        name="pattern",
        driver="fake",
        camera=CameraSection(
            width=size.width,
            height=size.height,
            rate_hz=rate_hz,
            fx=0.9 * size.width,
            mount=MountSection(forward=0.1, up=0.2, pitch_deg=15),
        ),
        base=BaseSection(wheel_radius=0.033, track_width=0.17, ticks_per_turn=1320),
        arm=ArmSection(
            shoulder_forward=0.05,
            shoulder_up=0.1,
            upper_length=0.12,
            fore_length=0.12,
            hand_length=0.08,
            claw_max=0.07,
            rotation_limits_deg=(-90, 90),
            shoulder_limits_deg=(-60, 90),
            elbow_limits_deg=(-90, 90),
            standard=standard,
            stowed=standard,
        ),
    )
