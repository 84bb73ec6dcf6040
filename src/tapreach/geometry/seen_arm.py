"""An arm as the camera sees it: servos that stand off their zeros, under a camera that is not quite where its
file says.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.arm_kinematics import ArmJoints, ArmKinematics, Reach
from tapreach.geometry.finite import FloatArray, finite_array


@dataclass(frozen=True, eq=False)
class SeenArm:
    """See ArmKinematics. Joints are what the servos are sent; places are in `seen`, the base frame as the
    camera shows it, where the things that it sees are too.

    arm: by its file. zeros (3,): what the servos add to rotation, shoulder, elbow [rad]. seen_from_base: the
    frame `seen` from that of the base; a small motion. `inverse` holds the limits of the arm's true joints.
    """

    arm: ArmKinematics
    zeros: FloatArray
    seen_from_base: RigidTransform

    def __post_init__(self) -> None:
        object.__setattr__(self, "zeros", finite_array("zeros", self.zeros, (3,)))

    def true_joints(self, sent: ArmJoints) -> ArmJoints:
        """Return where the joints stand when the servos are sent to `sent`."""
        return _plus(sent, self.zeros)

    def forward(self, joints: ArmJoints) -> FloatArray:
        """See ArmKinematics: (3,) in the frame `seen` [m]."""
        return np.asarray(self.seen_from_base.apply(self.arm.forward(self.true_joints(joints))))

    def skeleton(self, joints: ArmJoints) -> FloatArray:
        """See ArmKinematics: (n, 3) in the frame `seen` [m]."""
        return np.asarray(self.seen_from_base.apply(self.arm.skeleton(self.true_joints(joints))))

    def inverse(self, tip_in_base: npt.ArrayLike, near: ArmJoints | None = None) -> Reach:
        """See ArmKinematics: what to send the servos for the tips to be at (3,) in the frame `seen`."""
        goal = self.seen_from_base.inv().apply(finite_array("tip_in_base", tip_in_base, (3,)))
        reach = self.arm.inverse(goal, None if near is None else self.true_joints(near))
        if reach.joints is None:
            return reach
        return Reach(reach.status, reach.reason, _plus(reach.joints, -self.zeros), reach.missing)


def _plus(joints: ArmJoints, angles: FloatArray) -> ArmJoints:
    a, b, c = (float(angle) for angle in angles)
    return ArmJoints(joints.rotation + a, joints.shoulder + b, joints.elbow + c)
