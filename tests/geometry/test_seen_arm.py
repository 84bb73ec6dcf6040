"""An arm as the camera sees it: servos that stand off, in a frame that is off."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from tapreach.errors import InputError
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints, ReachStatus
from tapreach.geometry.claw_frame import base_from_gripper
from tapreach.geometry.seen_arm import SeenArm

ARM = ArmGeometry((0.02, -0.045, 0.121), 0.12, 0.12, 0.072)
OFF = RigidTransform.from_components([0.004, -0.007, 0.002], Rotation.from_rotvec([0.01, -0.03, 0.02]))
SEEN = SeenArm(ARM, np.array([0.05, -0.03, 0.04]), OFF)


def test_what_is_sent_for_a_place_brings_the_tip_there() -> None:
    goal = np.array([0.26, -0.02, 0.06])
    reach = SEEN.inverse(goal)
    assert reach.joints is not None
    assert SEEN.forward(reach.joints) == pytest.approx(goal, abs=1e-9)
    assert SEEN.skeleton(reach.joints)[-1] == pytest.approx(goal, abs=1e-9)
    # By its file alone the arm would be sent elsewhere.
    assert np.linalg.norm(ARM.forward(reach.joints) - goal) > 0.01


def test_tip_is_where_the_true_joints_bring_it() -> None:
    sent = ArmJoints(0.2, 0.7, 0.3)
    true = ArmJoints(0.25, 0.67, 0.34)
    assert SEEN.forward(sent) == pytest.approx(OFF.apply(ARM.forward(true)), abs=1e-12)


def test_place_out_of_reach_says_so() -> None:
    reach = SEEN.inverse([0.6, 0.0, 0.1])
    assert reach.status is ReachStatus.TOO_FAR
    assert reach.joints is None


def test_claw_frame_has_x_out_of_the_hand_and_y_to_the_left() -> None:
    pose = base_from_gripper(ARM, ArmJoints(0.3, 0.6, 0.2))
    assert pose.translation == pytest.approx(ARM.forward(ArmJoints(0.3, 0.6, 0.2)))
    ahead, left = np.array([np.cos(0.3), np.sin(0.3), 0.0]), np.array([-np.sin(0.3), np.cos(0.3), 0.0])
    assert pose.rotation.apply([1.0, 0.0, 0.0]) == pytest.approx(ahead)
    assert pose.rotation.apply([0.0, 1.0, 0.0]) == pytest.approx(left)


def test_hand_that_points_straight_up_has_no_left() -> None:
    class Upright(ArmGeometry):
        def skeleton(self, joints: ArmJoints) -> np.ndarray:
            return np.array([[0.0, 0.0, 0.1], [0.0, 0.0, 0.2], [0.0, 0.0, 0.3]])

    with pytest.raises(InputError, match="upright"):
        base_from_gripper(Upright((0.0, 0.0, 0.1), 0.1, 0.1, 0.05), ArmJoints(0.0, 0.0, 0.0))
