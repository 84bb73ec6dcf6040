"""Arms as chains of joints: the paper's as a special case, others against what must hold for any."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.arm_chain import ArmChain, ChainJoint
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints, ReachStatus
from tapreach.geometry.chain_arm import ChainArm
from tapreach.geometry.chain_inverse import NEAR_ENOUGH, solve_chain

RANGES = ((-1.3, 1.3), (-0.8, 1.6), (-0.9, 1.7))
PAPER = ArmGeometry((0.02, -0.045, 0.12), 0.12, 0.11, 0.07, *RANGES)
SAME = ChainArm(
    ArmChain(
        (
            ChainJoint((0.0, 0.0, 2.0), (0.02, -0.045, 0.12), *RANGES[0]),
            ChainJoint((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), *RANGES[1]),
            ChainJoint((0.0, 1.0, 0.0), (0.0, 0.0, 0.12), *RANGES[2]),
        ),
        wrist=(0.11, 0.0, 0.0),
        hand=(0.07, 0.0, 0.0),
    )
)
# A shoulder set off sideways and an elbow whose axis is slanted: no closed form, and often two solutions.
CROOKED = ArmChain(
    (
        ChainJoint((0.0, 0.0, 1.0), (0.05, 0.0, 0.1), -2.5, 2.5),
        ChainJoint((0.0, 1.0, 0.0), (0.03, 0.02, 0.02), -1.5, 1.5),
        ChainJoint((0.3, 1.0, 0.1), (0.01, -0.01, 0.13), -1.8, 1.8),
    ),
    wrist=(0.12, 0.01, 0.0),
    hand=(0.05, 0.0, -0.01),
    is_hand_level=False,
)
FIVE = ArmChain(
    tuple(
        ChainJoint(axis, (0.0, 0.0, 0.08), -2.0, 2.0)
        for axis in ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ),
    wrist=(0.05, 0.0, 0.0),
    hand=(0.05, 0.0, 0.0),
    is_hand_level=False,
)
joints = st.builds(ArmJoints, *(st.floats(low, high) for low, high in RANGES))


def angles_of(chain: ArmChain) -> st.SearchStrategy[list[float]]:
    return st.tuples(*(st.floats(joint.low, joint.high) for joint in chain.joints)).map(list)


@given(joints)
def test_chain_of_the_papers_arm_agrees_with_its_closed_form(pose):
    np.testing.assert_allclose(SAME.skeleton(pose)[1:], PAPER.skeleton(pose), atol=1e-12)


@given(joints)
@settings(deadline=None)
def test_solver_finds_the_papers_arm_wherever_it_can_be(pose):
    tip = PAPER.forward(pose)
    reach = SAME.inverse(tip)
    assert reach.joints is not None, reach
    np.testing.assert_allclose(PAPER.forward(reach.joints), tip, atol=2.0 * NEAR_ENOUGH)
    found = (reach.joints.rotation, reach.joints.shoulder, reach.joints.elbow)
    assert all(low <= angle <= high for angle, (low, high) in zip(found, RANGES, strict=True))


@pytest.mark.parametrize("chain", [CROOKED, FIVE], ids=["crooked", "five joints"])
def test_solver_reaches_whatever_a_chain_can_reach(chain):
    rng = np.random.default_rng(4)
    for _ in range(60):
        tip = chain.skeleton(rng.uniform(*chain.ranges.T))[-1]
        solution = solve_chain(chain, tip)
        np.testing.assert_allclose(chain.skeleton(solution.angles)[-1], tip, atol=2.0 * NEAR_ENOUGH)
        assert np.all(solution.angles >= chain.ranges[:, 0])
        assert np.all(solution.angles <= chain.ranges[:, 1])


@pytest.mark.parametrize("chain", [SAME.chain, CROOKED, FIVE], ids=["level", "crooked", "five joints"])
def test_jacobian_is_the_change_of_the_tip(chain):
    angles, step = np.linspace(0.2, 0.9, len(chain.joints)), 1e-6
    _, jacobian = chain.placed(angles)
    for index in range(len(angles)):
        nudge = step * np.eye(len(angles))[index]
        change = chain.skeleton(angles + nudge)[-1] - chain.skeleton(angles - nudge)[-1]
        np.testing.assert_allclose(jacobian[:, index], change / (2.0 * step), atol=1e-8)


@given(angles_of(CROOKED))
def test_links_keep_their_lengths(angles):
    lengths = np.linalg.norm(np.diff(CROOKED.skeleton(angles), axis=0), axis=1)
    wanted = [math.hypot(0.03, 0.02, 0.02), math.hypot(0.01, 0.01, 0.13), math.hypot(0.12, 0.01)]
    np.testing.assert_allclose(lengths[:3], wanted, atol=1e-12)


@given(joints)
def test_level_hand_stays_level_and_turns_with_the_first_joint(pose):
    wrist, tip = SAME.skeleton(pose)[-2:]
    direction = [math.cos(pose.rotation), math.sin(pose.rotation), 0.0]
    np.testing.assert_allclose((tip - wrist) / 0.07, direction, atol=1e-12)


def test_along_a_line_the_solver_stays_on_its_branch():
    angles = np.array([0.4, 0.3, 0.8])
    begin, end = CROOKED.skeleton(angles)[-1], CROOKED.skeleton([0.5, 0.5, 0.6])[-1]
    for tip in np.linspace(begin, end, 12):
        solution = solve_chain(CROOKED, tip, angles)
        assert solution.is_there
        assert np.abs(solution.angles - angles).max() < 0.2
        angles = solution.angles


def test_place_too_far_says_by_how_much():
    reach = SAME.inverse((0.6, -0.045, 0.12))
    assert reach.status is ReachStatus.TOO_FAR
    assert reach.missing == pytest.approx(0.6 - 0.02 - 0.12 - 0.11 - 0.07, abs=1e-4)
    assert reach.reason == "28.0 cm beyond reach"


def test_place_in_the_arms_own_column_is_too_near():
    reach = SAME.inverse((0.021, -0.045, 0.12))
    assert reach.status in (ReachStatus.TOO_NEAR, ReachStatus.BEYOND_JOINT_RANGE)
    assert reach.joints is None


def test_place_beyond_a_stop_names_the_joint():
    behind = PAPER.forward(ArmJoints(2.0, 0.9, 0.2))
    reach = SAME.inverse(behind)
    assert reach.status is ReachStatus.BEYOND_JOINT_RANGE
    assert reach.missing > 0.0
    assert "it goes from" in reach.reason


def test_what_is_no_chain_is_refused():
    with pytest.raises(InputError, match="axis"):
        ChainJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.1), -1.0, 1.0)
    with pytest.raises(InputError, match="smaller"):
        ChainJoint((0.0, 0.0, 1.0), (0.0, 0.0, 0.1), 1.0, -1.0)
    with pytest.raises(InputError, match="at least one joint"):
        ArmChain((), (0.1, 0.0, 0.0), (0.1, 0.0, 0.0))
    with pytest.raises(InputError, match="exactly 3"):
        ChainArm(FIVE)
    with pytest.raises(InputError, match="tip_in_base"):
        SAME.inverse((math.inf, 0.0, 0.0))
