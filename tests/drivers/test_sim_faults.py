import math

import numpy as np
import pytest
from sim_world import ROBOT, Rig

from tapreach.drivers.sim.encoders import Encoders
from tapreach.drivers.sim.faults import SimFaults
from tapreach.errors import ConfigError


def test_every_fault_is_described() -> None:
    assert all(field.description for field in SimFaults.model_fields.values())


def test_merged_faults_win_and_the_others_stay() -> None:
    faults = SimFaults().merged({"slip": 0.1, "motion_blur_ms": 8.0}).merged({"slip": 0.2})
    assert (faults.slip, faults.motion_blur_ms, faults.jpeg_quality) == (0.2, 8.0, 80)


@pytest.mark.parametrize("value", [math.nan, math.inf, -0.1, "much"])
def test_impossible_fault_is_refused(value: object) -> None:
    with pytest.raises(ConfigError, match="fault slip"):
        SimFaults().merged({"slip": value})


def heading_and_way(duration_s: float = 3.0, angular: float = 0.0, **faults: float) -> Rig:
    rig = Rig(faults=faults)
    rig.drive(0.2 if not angular else 0.0, angular, duration_s)
    return rig


def test_wheel_errors_bend_the_way_while_odometry_sees_it_straight() -> None:
    rig = heading_and_way(wheel_left_error=0.03, wheel_right_error=-0.03)
    assert abs(rig.reading.world_from_base.heading) < 0.2 * rig.pose.heading
    assert rig.pose.heading > 0.1, "the left wheel counts too much, so it turns too little: bends left"


def test_equal_wheel_errors_change_the_scale() -> None:
    rig = heading_and_way(wheel_left_error=0.05, wheel_right_error=0.05)
    assert rig.reading.world_from_base.x / rig.pose.x == pytest.approx(1.05, abs=0.01)


def test_slip_makes_the_encoders_count_more_than_the_way() -> None:
    rig = heading_and_way(slip=0.1)
    assert rig.reading.world_from_base.x / rig.pose.x == pytest.approx(1 / 0.9, abs=0.01)


def test_wider_track_turns_less_than_odometry_believes() -> None:
    rig = heading_and_way(angular=0.6, track_error=0.1)
    assert rig.reading.world_from_base.heading / rig.pose.heading == pytest.approx(1.1, abs=0.03)


def test_slip_noise_spreads_as_the_root_of_the_way() -> None:
    turns = 20.0
    ends = []
    for seed in range(60):
        encoders = Encoders(1e6, 0.033, SimFaults(slip_noise=0.02), seed)
        for angle in np.linspace(0, 2 * math.pi * turns, 200):
            ticks = encoders.read(float(angle), float(angle))
        ends.append(ticks)
    metres = np.array(ends) / 1e6 * 2 * math.pi * 0.033
    way = 2 * math.pi * 0.033 * turns
    # angle noise 0.02/√m of the wheel's turning, in metres: 0.02 · √way · radius / radius
    assert metres.mean() == pytest.approx(way, abs=0.02)
    assert metres.std() == pytest.approx(0.02 * math.sqrt(way), rel=0.3)


def test_coarse_encoders_count_few_ticks_of_the_same_way() -> None:
    rig = Rig(faults={"encoder_ticks_per_turn": 20})
    rig.drive(0.2, 0.0, 3.0)
    left, _ = rig.world.board_state().ticks
    turned = rig.world.data.joint("wheel_left").qpos[0] / (2 * math.pi)
    assert left == pytest.approx(20 * turned, abs=2)
    assert ROBOT.base.ticks_per_turn > 1000


def test_servo_offset_and_backlash_are_unknown_to_the_board() -> None:
    rig = Rig(faults={"servo_offset_deg": 4.0, "servo_backlash_deg": 0.0})
    exact = Rig(faults={"servo_backlash_deg": 0.0})
    for each in (rig, exact):
        each.world.move_arm(ROBOT.arm.standard.pose())
        each.step(150)
    assert rig.world.board_state().arm == exact.world.board_state().arm
    shift = math.degrees(
        float((rig.world.data.joint("rotation").qpos - exact.world.data.joint("rotation").qpos)[0])
    )
    assert shift == pytest.approx(4.0, abs=0.5)


def test_backlash_makes_the_joint_depend_on_the_direction_of_approach() -> None:
    from tapreach.drivers.sim.board import Servo

    servo = Servo(speed=2.0, resolution=0.0, position=0.0, backlash=0.1)
    servo.target = 1.0
    up = [servo.step(0.02) for _ in range(40)][-1]
    servo.target = 2.0
    for _ in range(60):
        servo.step(0.02)
    servo.target = 1.0
    down = [servo.step(0.02) for _ in range(60)][-1]
    assert (up, down) == (pytest.approx(0.95), pytest.approx(1.05))
