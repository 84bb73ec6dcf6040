"""The arm of a robot file: by its sizes or by its joints, never by both or by half."""

import pytest

from tapreach.errors import ConfigError
from tapreach.geometry.arm_kinematics import ArmGeometry, ArmJoints
from tapreach.geometry.chain_arm import ChainArm
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription
from tapreach.robot.toml_file import parse_validated

FILE = (resource_path("robots") / "sim.toml").read_text(encoding="utf-8")
SIZES = """shoulder_forward = 0.02
shoulder_left = -0.045
shoulder_up = 0.121
upper_length = 0.12
fore_length = 0.12
hand_length = 0.072
"""
CHAIN = """
[arm.chain]           # the same arm by its joints, all servos at 0
wrist = [0.12, 0, 0]
hand = [0.072, 0, 0]

[[arm.chain.joints]]
axis = [0, 0, 1]
offset = [0.02, -0.045, 0.121]

[[arm.chain.joints]]
axis = [0, 1, 0]
offset = [0, 0, 0]

[[arm.chain.joints]]
axis = [0, 1, 0]
offset = [0, 0, 0.12]
"""


def robot(text: str) -> RobotDescription:
    return parse_validated(text, "robot.toml", RobotDescription)


def test_sizes_make_the_closed_form():
    assert isinstance(robot(FILE).arm.kinematics(), ArmGeometry)


def test_joints_make_a_chain_that_is_the_same_arm():
    assert SIZES in FILE
    section = robot(FILE.replace(SIZES, "") + CHAIN).arm
    arm, closed_form = section.kinematics(), robot(FILE).arm.kinematics()
    assert isinstance(arm, ChainArm)
    pose = ArmJoints(0.4, 0.7, 0.3)
    assert arm.forward(pose) == pytest.approx(closed_form.forward(pose), abs=1e-12)
    assert arm.chain.joints[1].low == pytest.approx(-0.8727, abs=1e-4), "from shoulder_limits_deg"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (SIZES, "", "arm.chain"),
        ("fore_length = 0.12\n", "", "fore_length"),
        ("[simulation]", CHAIN + "\n[simulation]", "leave out shoulder_forward"),
        ("rotation_limits_deg = [-80, 80]", "rotation_limits_deg = [80, -80]", "smaller"),
        ("x = [-0.145, 0.065]", "x = [0.145, 0.065]", "must have a size"),
    ],
)
def test_arm_described_by_half_or_twice_is_refused(old, new, words):
    assert old in FILE
    with pytest.raises(ConfigError, match=words.replace("[", r"\[")):
        robot(FILE.replace(old, new))


def test_chain_with_a_joint_too_many_names_the_place():
    four = CHAIN + "\n[[arm.chain.joints]]\naxis = [0, 1, 0]\noffset = [0, 0, 0.1]\n"
    with pytest.raises(ConfigError, match=r"arm\.chain\.joints"):
        robot(FILE.replace(SIZES, "") + four)


def test_parts_of_the_body_are_boxes_in_the_base_frame():
    chassis = robot(FILE).body[0].box()
    assert chassis.name == "chassis"
    assert chassis.low == (-0.145, -0.062, 0.045)
    assert chassis.high == (0.065, 0.062, 0.081)
