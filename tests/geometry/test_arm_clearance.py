"""Distances of the arm from floor and base, against points scattered over the solids."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.arm_clearance import ArmShape, BodyBox, Capsule, arm_capsules, clearance
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints

SHAPE = ArmShape(0.010, 0.011, 0.025, 0.006, 0.06)
ARM = ArmGeometry((0.02, -0.045, 0.121), 0.12, 0.12, 0.072)
BOX = BodyBox("chassis", (-0.1, -0.06, 0.04), (0.06, 0.06, 0.08))
place = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(0.05, 0.4)).map(np.array)


def capsules(joints: ArmJoints, claw: float = 0.03) -> tuple[Capsule, ...]:
    return arm_capsules(ARM.skeleton(joints), claw, SHAPE)


@given(place, place)
@settings(deadline=None)
def test_distance_from_a_box_is_that_of_the_nearest_points(start, end):
    found = clearance([Capsule("link", start, end, 0.01)], [BOX])
    line = start + np.linspace(0.0, 1.0, 400)[:, None] * (end - start)
    nearest = np.clip(line, BOX.low, BOX.high)
    truth = min(np.linalg.norm(line - nearest, axis=1).min(), line[:, 2].min()) - 0.01
    if truth > -0.009:
        assert found.distance == pytest.approx(truth, abs=0.0025)
    else:
        assert found.distance < -0.008


def test_level_arm_before_the_robot_is_as_high_as_its_hand_is_above_the_floor():
    reach = ARM.inverse((0.28, -0.045, 0.03))
    assert reach.joints is not None
    nearest = clearance(capsules(reach.joints), [BOX])
    assert (nearest.part, nearest.other) == ("claw", "floor")
    assert nearest.distance == pytest.approx(0.03 - 0.011, abs=1e-9)


def test_arm_that_leans_into_the_base_is_too_near_by_its_depth():
    nearest = clearance(capsules(ArmJoints(0.0, -1.2, 2.3)), [BOX])
    assert nearest.other == "chassis"
    assert nearest.distance < 0.0


def test_fingers_reach_beyond_the_tip_and_as_wide_as_they_open():
    reach = ARM.inverse((0.28, -0.045, 0.03))
    assert reach.joints is not None
    ahead = BodyBox("wall", (0.315, -1.0, 0.0), (0.4, 1.0, 1.0))
    assert clearance(capsules(reach.joints), [ahead]).distance == pytest.approx(0.01, abs=1e-3)
    beside = BodyBox("post", (0.25, 0.0, 0.0), (0.3, 0.01, 1.0))
    closed, wide = (clearance(capsules(reach.joints, claw), [beside]).distance for claw in (0.06, 0.07))
    assert closed == pytest.approx(0.045 - 0.030 - 0.006, abs=1e-3)
    assert wide == pytest.approx(0.045 - 0.035 - 0.006, abs=1e-3)


def test_end_that_stands_on_the_base_does_not_count():
    low = ArmGeometry((0.02, -0.045, 0.085), 0.12, 0.12, 0.072)
    upright = arm_capsules(low.skeleton(ArmJoints(0.0, 0.0, 0.0)), 0.03, SHAPE)
    assert clearance(upright, [BOX]).distance > 0.0


def test_sizes_that_cannot_be_are_refused():
    with pytest.raises(InputError, match="must have a size"):
        BodyBox("flat", (0.0, 0.0, 0.0), (0.1, 0.1, 0.0))
    with pytest.raises(InputError, match="link_radius"):
        ArmShape(0.0, 0.011, 0.025, 0.006, 0.06)
