"""What one press of each of the paper's arm controls does."""

from dataclasses import replace
from math import degrees, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.control.arm_jog import jogged
from tapreach.robot.arm_section import ArmPoseSection, ArmSection
from tapreach.robot.messages import ArmPose

ARM = ArmSection(
    shoulder_forward=0.03,
    shoulder_up=0.09,
    upper_length=0.12,
    fore_length=0.12,
    hand_length=0.08,
    claw_max=0.07,
    rotation_limits_deg=(-90.0, 90.0),
    shoulder_limits_deg=(-60.0, 80.0),
    elbow_limits_deg=(-70.0, 75.0),
    standard=ArmPoseSection(shoulder_deg=-40.0, elbow_deg=40.0, claw=0.03),
    stowed=ArmPoseSection(shoulder_deg=-40.0, elbow_deg=40.0, claw=0.0),
)
MIDDLE = ArmPose(rotation=0.1, shoulder=radians(10.0), elbow=radians(-5.0), claw=0.03)
CONTROLS = ["T", "R", "left", "right", "forward", "backward"]
STEPS = [1, 5, 10, 20, 50]

angles = st.floats(-1.0, 1.0)
poses = st.builds(
    ArmPose,
    rotation=angles,
    shoulder=st.floats(radians(-60), radians(80)),
    elbow=st.floats(radians(-70), radians(75)),
    claw=st.floats(0.0, 0.07),
)


@pytest.mark.parametrize(
    ("control", "expected"),
    [
        ("T", replace(MIDDLE, claw=0.02)),
        ("R", replace(MIDDLE, claw=0.04)),
        ("left", replace(MIDDLE, rotation=0.1 + radians(10.0))),
        ("right", replace(MIDDLE, rotation=0.1 - radians(10.0))),
        ("forward", replace(MIDDLE, shoulder=radians(20.0), elbow=radians(-15.0))),
        ("backward", replace(MIDDLE, shoulder=0.0, elbow=radians(5.0))),
    ],
)
def test_press_of_ten_degrees(control, expected):
    pose = jogged(MIDDLE, control, 10, ARM)
    assert (pose.rotation, pose.shoulder, pose.elbow, pose.claw) == pytest.approx(
        (expected.rotation, expected.shoulder, expected.elbow, expected.claw)
    )


@given(poses, st.sampled_from(["forward", "backward"]), st.sampled_from(STEPS))
def test_forearm_keeps_its_direction_also_at_the_limits(pose, control, step_deg):
    after = jogged(pose, control, step_deg, ARM)
    assert after.shoulder + after.elbow == pytest.approx(pose.shoulder + pose.elbow)


@given(poses, st.sampled_from(CONTROLS), st.sampled_from(STEPS))
def test_no_press_leaves_the_limits_or_turns_more_than_the_step(pose, control, step_deg):
    after = jogged(pose, control, step_deg, ARM)
    assert -60.0 - 1e-6 <= degrees(after.shoulder) <= 80.0 + 1e-6
    assert -70.0 - 1e-6 <= degrees(after.elbow) <= 75.0 + 1e-6
    assert -90.0 - 1e-6 <= degrees(after.rotation) <= 90.0 + 1e-6
    assert 0.0 <= after.claw <= 0.07
    for name in ("rotation", "shoulder", "elbow"):
        assert abs(getattr(after, name) - getattr(pose, name)) <= radians(step_deg) + 1e-9


def test_joint_beyond_its_limit_may_come_back_but_not_go_on():
    outside = replace(MIDDLE, rotation=radians(100.0))
    assert jogged(outside, "left", 10, ARM).rotation == pytest.approx(radians(100.0))
    assert jogged(outside, "right", 10, ARM).rotation == pytest.approx(radians(90.0))
