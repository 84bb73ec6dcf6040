"""The paper's arm controls: what one press does to the four servos."""

from dataclasses import replace
from math import radians
from typing import Literal

from tapreach.robot.arm_section import ArmSection
from tapreach.robot.messages import ArmPose
from tapreach.robot.section import RangeDeg

Control = Literal["T", "R", "left", "right", "forward", "backward"]
CLAW_TRAVEL_DEG = 70.0
"""Turn of servo D from closed to widest."""


def jogged(pose: ArmPose, control: Control, step_deg: float, arm: ArmSection) -> ArmPose:
    """Return the target after one press of `control` from `pose`, within the joint limits.

    T clamps and R releases; left and right turn A. Forward leans B by the step and takes it back from C, so
    that the forearm keeps its direction and the claw stays level; where one meets its limit, both stop.
    """
    if control in ("T", "R"):
        opening = arm.claw_max * step_deg / CLAW_TRAVEL_DEG
        change = -opening if control == "T" else opening
        return replace(pose, claw=min(arm.claw_max, max(0.0, pose.claw + change)))
    if control in ("left", "right"):
        change = radians(step_deg if control == "left" else -step_deg)
        return replace(
            pose, rotation=pose.rotation + _allowed(pose.rotation, change, arm.rotation_limits_deg)
        )
    wanted = radians(step_deg if control == "forward" else -step_deg)
    leaning = _allowed(pose.shoulder, wanted, arm.shoulder_limits_deg)
    bending = -_allowed(pose.elbow, -wanted, arm.elbow_limits_deg)
    change = min(leaning, bending, key=abs)
    return replace(pose, shoulder=pose.shoulder + change, elbow=pose.elbow - change)


def _allowed(angle: float, change: float, limits_deg: RangeDeg) -> float:
    # Never turns back by itself: a joint that stands beyond a limit moves inwards only when asked to.
    low, high = (radians(limit) for limit in limits_deg)
    if change > 0.0:
        return min(change, max(0.0, high - angle))
    return max(change, min(0.0, low - angle))
