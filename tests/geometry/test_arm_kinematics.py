"""The arm's closed form: forward and inverse, and why a place is out of reach."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints, ReachStatus

ARM = ArmGeometry((0.07, 0.0, 0.12), 0.12, 0.11, 0.07)


def test_upright_arm_holds_its_forearm_level_ahead():
    np.testing.assert_allclose(ARM.forward(ArmJoints(0.0, 0.0, 0.0)), [0.07 + 0.11 + 0.07, 0.0, 0.24])


def test_joints_turn_the_way_they_are_named():
    tip = ARM.forward(ArmJoints(0.0, 0.0, 0.0))
    assert ARM.forward(ArmJoints(0.3, 0.0, 0.0))[1] > 0.0
    assert ARM.forward(ArmJoints(0.0, 0.3, 0.0))[0] > tip[0]
    assert ARM.forward(ArmJoints(0.0, 0.0, 0.3))[2] < tip[2]


@given(st.floats(-3.0, 3.0), st.floats(-0.5, 1.5), st.floats(-1.5, 1.5))
def test_forward_of_inverse_is_the_place_asked_for(rotation, shoulder, elbow):
    tip = ARM.forward(ArmJoints(rotation, shoulder, elbow))
    if np.hypot(*(tip[:2] - ARM.shoulder_in_base[:2])) < ARM.hand + 0.01:
        return
    reach = ARM.inverse(tip)
    assert reach.joints is not None
    np.testing.assert_allclose(ARM.forward(reach.joints), tip, atol=1e-7)


def test_inverse_keeps_the_elbow_up():
    reach = ARM.inverse((0.25, 0.05, 0.05))
    assert reach.joints is not None
    assert reach.joints.elbow > -math.pi / 2


def test_place_beyond_the_arm_says_how_far_beyond():
    reach = ARM.inverse((0.07 + 0.07 + 0.23 + 0.05, 0.0, 0.12))
    assert reach.status is ReachStatus.TOO_FAR
    assert reach.joints is None
    assert reach.missing == pytest.approx(0.05)
    assert "5.0 cm" in reach.reason


def test_place_at_the_shoulder_is_too_near():
    assert ARM.inverse((0.07 + 0.07, 0.0, 0.121)).status is ReachStatus.TOO_NEAR


def test_place_that_needs_a_joint_beyond_its_range_names_the_joint():
    limited = ArmGeometry((0.07, 0.0, 0.12), 0.12, 0.11, 0.07, rotation_range=(-1.0, 1.0))
    reach = limited.inverse((0.07, 0.25, 0.12))
    assert reach.status is ReachStatus.BEYOND_JOINT_RANGE
    assert "rotation would have to be 90°" in reach.reason
    assert reach.missing == pytest.approx(math.pi / 2 - 1.0)


def test_place_that_is_no_number_is_refused():
    with pytest.raises(InputError, match="tip_in_base"):
        ARM.inverse((math.nan, 0.0, 0.0))


def test_arm_without_length_is_refused():
    with pytest.raises(InputError, match="upper"):
        ArmGeometry((0.0, 0.0, 0.1), 0.0, 0.1, 0.05)
