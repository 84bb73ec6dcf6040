"""What a robot file allows to be sent."""

from math import radians

from tapreach.robot.arm_section import ArmSection
from tapreach.robot.config import BaseSection
from tapreach.robot.messages import ArmPose, Twist


def limited_twist(twist: Twist, base: BaseSection) -> Twist:
    """Return `twist` scaled into the limits of the base, its curvature kept."""
    excess = max(1.0, abs(twist.linear) / base.max_linear, abs(twist.angular) / base.max_angular)
    return Twist(twist.linear / excess, twist.angular / excess)


def limited_arm(pose: ArmPose, arm: ArmSection) -> ArmPose:
    """Return `pose` with every joint within the limits of the robot file."""
    return ArmPose(
        _within(pose.rotation, arm.rotation_limits_deg),
        _within(pose.shoulder, arm.shoulder_limits_deg),
        _within(pose.elbow, arm.elbow_limits_deg),
        max(0.0, min(arm.claw_max, pose.claw)),
    )


def _within(angle: float, limits_deg: tuple[float, float]) -> float:
    return max(radians(limits_deg[0]), min(radians(limits_deg[1]), angle))
