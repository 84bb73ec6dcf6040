"""The frame `gripper` of an arm: where its claw is and which way it points."""

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.errors import InputError
from tapreach.geometry.arm_kinematics import ArmJoints, ArmKinematics
from tapreach.geometry.finite import FloatArray

_LEVEL = 1e-6


def base_from_gripper(arm: ArmKinematics, joints: ArmJoints) -> RigidTransform:
    """Return the pose of the claw: origin between the finger tips, x out of the hand, y left and level.

    Raises InputError for a hand that points straight up or down, where left is not told.
    """
    wrist, tip = arm.skeleton(joints)[-2:]
    ahead: FloatArray = tip - wrist
    left = np.array([-ahead[1], ahead[0], 0.0])
    across = float(np.linalg.norm(left))
    if across < _LEVEL:
        raise InputError(f"the hand points along {ahead.round(4).tolist()}: upright, so that it has no left")
    ahead, left = ahead / np.linalg.norm(ahead), left / across
    axes = np.stack([ahead, left, np.cross(ahead, left)], axis=1)
    return RigidTransform.from_components(tip, Rotation.from_matrix(axes))
