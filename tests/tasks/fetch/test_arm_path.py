"""Paths of the simulated rover's arm: straight, level, within limits, clear; and honest about what is not."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.arm_clearance import arm_capsules
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.resources import resource_path
from tapreach.robot.config import load_robot
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_path import (
    JOINT_SHARE,
    SPACING,
    ArmPath,
    joint_path,
    path_to,
    straight_path,
)
from tapreach.tasks.fetch.arm_workspace import MARGIN, ArmWorkspace, Unreachable
from tapreach.tasks.fetch.grip_motion import closed, lift_path, opened

ROBOT = load_robot(resource_path("robots") / "sim.toml")
ARM = ArmWorkspace.of(ROBOT)
STOWED, STANDARD = ROBOT.arm.stowed.pose(), ROBOT.arm.standard.pose()
tips = st.tuples(st.floats(0.18, 0.34), st.floats(-0.2, 0.1), st.floats(0.015, 0.2))


def at(x: float, y: float, z: float, claw: float = 0.05) -> ArmPose:
    pose = ARM.pose_at((x, y, z), claw)
    assert isinstance(pose, ArmPose), pose
    return pose


def inside_limits(pose: ArmPose) -> bool:
    arm = ROBOT.arm
    limits = (arm.rotation_limits_deg, arm.shoulder_limits_deg, arm.elbow_limits_deg)
    angles = (pose.rotation, pose.shoulder, pose.elbow)
    return all(
        low - 1e-6 <= math.degrees(angle) <= high + 1e-6
        for angle, (low, high) in zip(angles, limits, strict=True)
    )


@given(tips)
@settings(deadline=None, max_examples=60)
def test_line_is_straight_finely_divided_within_limits_and_clear(goal):
    start = at(0.2, -0.045, 0.05)
    path = straight_path(start, goal, ARM)
    if isinstance(path, Unreachable):
        assert path.reason
        return
    begin = ARM.tip(start)
    np.testing.assert_allclose(path.tips_in_base[-1], goal, atol=1e-9)
    for pose, tip in zip(path.poses, path.tips_in_base, strict=True):
        np.testing.assert_allclose(ARM.tip(pose), tip, atol=1e-9)
        along = (tip - begin) @ (np.array(goal) - begin)
        across = np.linalg.norm(np.cross(tip - begin, np.array(goal) - begin))
        assert along >= -1e-9
        assert across < 1e-9
        assert inside_limits(pose)
        assert pose.claw == start.claw
        assert ARM.clearance(pose).distance >= MARGIN - 1e-9
    steps = np.linalg.norm(np.diff(path.tips_in_base, axis=0), axis=1)
    assert steps.max(initial=0.0) <= SPACING + 1e-9


@given(tips, st.floats(0.02, 0.3))
@settings(deadline=None, max_examples=60)
def test_times_keep_the_speed_of_tip_and_joints(goal, speed):
    path = straight_path(at(0.2, -0.045, 0.05), goal, ARM)
    if isinstance(path, Unreachable):
        return
    timed = path.timed(ARM, speed)
    assert timed[0].time == 0.0
    for (first, second), way in zip(pairwise(timed), np.diff(path.tips_in_base, axis=0), strict=True):
        elapsed = second.time - first.time
        assert np.linalg.norm(way) <= speed * elapsed + 1e-9
        for joint in ("rotation", "shoulder", "elbow"):
            turn = abs(getattr(second.pose, joint) - getattr(first.pose, joint))
            assert turn <= JOINT_SHARE * ARM.joint_speed * elapsed + 1e-9


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        ((0.45, -0.045, 0.121), "11.8 cm beyond reach"),
        ((0.32, -0.045, 0.16), "elbow would have to be"),
        ((0.25, -0.045, 0.008), "floor"),
        ((0.10, -0.045, 0.06), "chassis"),
        ((0.17, 0.05, 0.125), "camera"),
        ((0.2, -0.4, 0.1), "beyond reach"),
    ],
)
def test_way_that_cannot_be_gone_says_why(goal, words):
    path = straight_path(at(0.2, -0.045, 0.10, claw=0.073), goal, ARM)
    assert isinstance(path, Unreachable)
    assert words in path.reason


def test_claw_wider_than_it_opens_is_refused():
    refused = ARM.pose_at((0.25, -0.045, 0.05), 0.08)
    assert refused == Unreachable("the claw opens to 73 mm, not to 80 mm")


def test_goal_that_is_no_number_is_refused():
    with pytest.raises(InputError, match="tip_goal_in_base"):
        straight_path(at(0.2, -0.045, 0.05), (0.2, math.nan, 0.1), ARM)


@pytest.mark.parametrize("start", [STOWED, STANDARD], ids=["stowed", "standard"])
@pytest.mark.parametrize("height", [0.02, 0.06, 0.12])
@pytest.mark.parametrize("aside", [-0.15, -0.045, 0.02])
def test_arm_gets_from_its_folded_poses_to_the_front_and_back(start, height, aside):
    before = at(0.2, aside, height, claw=ARM.claw_max)
    out, home = path_to(start, before, ARM, [STANDARD]), path_to(before, start, ARM, [STANDARD])
    assert isinstance(out, ArmPath)
    assert isinstance(home, ArmPath)
    assert (out.start, out.end) == (start, before)
    assert (home.start, home.end) == (before, start)
    for path in (out, home):
        least = min(MARGIN, ARM.clearance(start).distance)
        assert min(ARM.clearance(pose).distance for pose in path.poses) >= least - 1e-9
        narrow = [pose.claw for pose in path.poses if np.hypot(*(ARM.tip(pose) - ARM.tip(before))[:2]) > 0.03]
        assert max(narrow) <= start.claw, "on the way the claw is as narrow as it may be"


def test_even_turn_into_the_base_is_refused_and_another_way_found():
    right, left = at(0.16, -0.15, 0.10, claw=0.03), at(0.2, 0.02, 0.03, claw=0.03)
    under = replace(STOWED, shoulder=math.radians(-50.0), elbow=math.radians(100.0), rotation=0.6)
    refused = joint_path(right, under, ARM)
    assert isinstance(refused, Unreachable)
    assert "camera" in refused.reason or "chassis" in refused.reason
    assert isinstance(path_to(STOWED, left, ARM), ArmPath)


@pytest.mark.parametrize("pose", [STOWED, STANDARD], ids=["stowed", "standard"])
def test_folded_arm_is_not_in_the_picture(pose):
    lens, camera = ROBOT.camera.model(), ROBOT.camera.mount.base_from_camera().inv()
    skeleton = ARM.kinematics.skeleton(ArmJoints(pose.rotation, pose.shoulder, pose.elbow))
    for capsule in arm_capsules(skeleton, pose.claw, ARM.shape):
        line = np.linspace(capsule.start, capsule.end, 30)
        directions = np.random.default_rng(2).normal(size=(60, 3))
        round_ = capsule.radius * directions / np.linalg.norm(directions, axis=1, keepdims=True)
        points = camera.apply((line[:, None] + round_).reshape(-1, 3))
        seen = points[points[:, 2] > 1e-3]
        if len(seen):
            u, v = lens.project(seen).pixels.T
            size = lens.size
            inside = (u > -0.5) & (v > -0.5) & (u < size.width - 0.5) & (v < size.height - 0.5)
            assert not inside.any()


def test_stowed_arm_stays_behind_what_the_robot_meets_first():
    reach = max(
        float(max(capsule.start[0], capsule.end[0])) + capsule.radius
        for capsule in arm_capsules(
            ARM.kinematics.skeleton(ArmJoints(STOWED.rotation, STOWED.shoulder, STOWED.elbow)),
            STOWED.claw,
            ARM.shape,
        )
    )
    assert reach < 0.12


@pytest.mark.parametrize("reach", [0.22, 0.26, 0.30])
def test_lift_goes_up_first_and_ends_higher_and_no_farther_out(reach):
    start = closed(at(reach, -0.045, 0.03), 0.05)
    path = lift_path(start, ARM)
    assert isinstance(path, ArmPath)
    up = path.tips_in_base[:, 2] - path.tips_in_base[0, 2]
    assert np.all(np.diff(up) > 0.0)
    assert up[-1] >= 0.04 - 1e-9
    assert path.tips_in_base[-1, 0] <= reach + 1e-9
    np.testing.assert_allclose(path.tips_in_base[up < 0.0199][:, 0], reach, atol=1e-9)
    assert {pose.claw for pose in path.poses} == {start.claw}


def test_claw_opens_beside_the_thing_and_closes_past_it():
    pose = at(0.25, -0.045, 0.05)
    assert opened(pose, 0.04, 0.01, ARM).claw == pytest.approx(0.06)
    assert opened(pose, 0.07, 0.01, ARM).claw == ARM.claw_max
    assert closed(pose, 0.04).claw == pytest.approx(0.03)
    assert closed(pose, 0.04, 0.003).claw == pytest.approx(0.024)
    assert closed(pose, 0.005).claw == 0.0
