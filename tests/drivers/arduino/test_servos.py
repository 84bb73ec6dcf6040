import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.drivers.arduino.ros_arm import servo_degrees
from tapreach.drivers.arduino.servos import Servo, ServoMap, values_of
from tapreach.errors import ConfigError
from tapreach.resources import resource_path
from tapreach.robot.config import load_robot
from tapreach.robot.messages import ArmPose

ARM = load_robot(resource_path("robots") / "rover-pi.toml").arm
MAP = ServoMap(ARM)


@given(st.floats(-1.39, 1.39), st.floats(-0.87, 1.57), st.floats(-0.95, 1.53), st.floats(0.0, ARM.claw_max))
def test_pulses_lead_back_to_the_pose_within_a_microsecond(a, b, c, d):
    pose = MAP.limited(ArmPose(a, b, c, d))
    back = MAP.pose(MAP.pulses_us(pose))
    for servo, value, again in zip(MAP.servos, values_of(pose), values_of(back), strict=True):
        assert abs(value - again) <= 0.51 / abs(servo.us_per_unit)


def test_reversed_servo_turns_the_other_way_and_others_do_not():
    zero, bent = ArmPose(0, 0, 0, 0.01), ArmPose(0.1, 0.1, 0.1, 0.02)
    a, b, c, d = (y - x for x, y in zip(MAP.pulses_us(zero), MAP.pulses_us(bent), strict=True))
    assert min(a, b, d) > 0
    assert c == pytest.approx(-10 * math.degrees(0.1), abs=1)  # reversed in the file


def test_servo_that_reaches_less_than_its_joint_limits_the_pose_and_the_answer_says_so():
    narrow = ARM.servos.rotation.model_copy(update={"low_us": 1300, "high_us": 1600})
    servos = ARM.servos.model_copy(update={"rotation": narrow})
    limited = ServoMap(ARM.model_copy(update={"servos": servos}))
    pose = limited.limited(ArmPose(1.0, 0.0, 0.0, 0.0))
    assert math.degrees(pose.rotation) == pytest.approx(10.0)
    assert limited.pulses_us(replace(pose, rotation=9.0))[0] == 1600


def test_servo_without_pulse_counts_as_stowed():
    assert MAP.pose((0, 0, 0, 0)) == ARM.stowed.pose()


def test_speeds_are_the_robot_files():
    assert MAP.speeds_us_per_s()[:3] == (900, 900, 900)  # 90 deg/s at 10 us/deg


def test_arm_without_servos_is_refused():
    with pytest.raises(ConfigError, match=r"no \[arm.servos\]"):
        ServoMap(ARM.model_copy(update={"servos": None}))


def test_limits_of_a_reversed_servo_are_in_order():
    servo = Servo(1500.0, -100.0, 1000, 2000)
    assert servo.limited(9.0) == 5.0
    assert servo.limited(-9.0) == -5.0


@pytest.mark.parametrize(("pulse", "degrees"), [(544, 0), (1472, 90), (2400, 180), (100, 0), (3000, 180)])
def test_degrees_of_the_servo_library_are_whole_and_within_its_range(pulse, degrees):
    assert servo_degrees(pulse) == degrees
