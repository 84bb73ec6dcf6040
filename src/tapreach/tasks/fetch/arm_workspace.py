"""Where the arm can be: its solver, its limits, and how clear of floor and base it is there."""

from dataclasses import dataclass

import numpy.typing as npt

from tapreach.geometry.arm_clearance import ArmShape, BodyBox, Clearance, arm_capsules, clearance
from tapreach.geometry.arm_kinematics import ArmJoints, ArmKinematics
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import ArmPose

MARGIN = 0.004
"""Least distance [m] kept from floor and base."""


@dataclass(frozen=True)
class Unreachable:
    """Why the arm cannot be there or go there, in words a person can act on."""

    reason: str


@dataclass(frozen=True)
class ArmWorkspace:
    """The arm of one robot. claw_max [m], joint_speed [rad/s]: the fastest of its servos."""

    kinematics: ArmKinematics
    shape: ArmShape
    boxes: tuple[BodyBox, ...]
    claw_max: float
    joint_speed: float

    @classmethod
    def of(cls, description: RobotDescription) -> "ArmWorkspace":
        """Return what the robot file says of it."""
        arm = description.arm
        boxes = tuple(section.box() for section in description.body)
        return cls(arm.kinematics(), arm.shape(), boxes, arm.claw_max, arm.joint_speed)

    def tip(self, pose: ArmPose) -> FloatArray:
        """Return the point between the finger tips, (3,) in the base frame [m]."""
        return self.kinematics.forward(_joints(pose))

    def clearance(self, pose: ArmPose) -> Clearance:
        """Return what of the arm is nearest to the floor or the base."""
        return clearance(
            arm_capsules(self.kinematics.skeleton(_joints(pose)), pose.claw, self.shape), self.boxes
        )

    def pose_at(
        self, tip_in_base: npt.ArrayLike, claw: float, near: ArmPose | None = None
    ) -> ArmPose | Unreachable:
        """Return the pose that brings the finger tips to (3,) in the base frame [m], opened by `claw` [m].

        Within the joints' limits; whether it is clear of floor and base, `hindrance` tells. Of several
        solutions the one near `near`. Raises InputError for coordinates that are not finite.
        """
        if not 0.0 <= claw <= self.claw_max:
            return Unreachable(f"the claw opens to {_mm(self.claw_max)}, not to {_mm(claw)}")
        reach = self.kinematics.inverse(tip_in_base, None if near is None else _joints(near))
        if reach.joints is None:
            return Unreachable(reach.reason)
        return ArmPose(reach.joints.rotation, reach.joints.shoulder, reach.joints.elbow, claw)

    def hindrance(self, pose: ArmPose, margin: float = MARGIN) -> str:
        """Return what the arm would come too near to in `pose`; '' when it keeps `margin` [m]."""
        nearest = self.clearance(pose)
        if nearest.distance >= margin:
            return ""
        if nearest.distance < 0.0:
            return f"the {nearest.part} would run into the {nearest.other}"
        return f"the {nearest.part} would come within {_mm(nearest.distance)} of the {nearest.other}"


def _joints(pose: ArmPose) -> ArmJoints:
    return ArmJoints(pose.rotation, pose.shoulder, pose.elbow)


def _mm(metres: float) -> str:
    return f"{1000.0 * metres:.0f} mm"
