import math
from pathlib import Path

import numpy as np
import pytest
from sim_world import HALL, ROBOT, Rig

from tapreach.drivers.sim.scene import Scene
from tapreach.robot.messages import ArmPose, Twist


def test_straight_drive_keeps_its_line_and_agrees_with_odometry() -> None:
    rig = Rig()
    rig.drive(0.2, 0.0, 5.0)
    assert rig.pose.x == pytest.approx(1.0, abs=0.05)
    assert abs(rig.pose.y) < 0.03
    assert rig.reading.world_from_base.x == pytest.approx(rig.pose.x, rel=0.01)
    assert rig.reading.twist.linear == pytest.approx(0.2, abs=0.02)
    assert rig.reading.distance == pytest.approx(rig.pose.x, rel=0.01)


def test_backward_drive_goes_backward() -> None:
    rig = Rig()
    rig.drive(-0.2, 0.0, 2.0)
    assert rig.pose.x < -0.3
    assert rig.reading.world_from_base.x == pytest.approx(rig.pose.x, rel=0.02)


@pytest.mark.parametrize("rate", [0.6, -0.6])
def test_positive_angular_speed_turns_left_and_agrees_with_odometry(rate: float) -> None:
    rig = Rig()
    rig.drive(0.0, rate, 2.0)
    assert math.copysign(1.0, rate) * rig.pose.heading == pytest.approx(1.2, abs=0.15)
    assert rig.reading.world_from_base.heading == pytest.approx(rig.pose.heading, rel=0.03)
    assert math.hypot(rig.pose.x, rig.pose.y) < 0.02, "the axis of turning is between the wheels"


def test_base_frame_is_on_the_floor_between_the_wheels() -> None:
    rig = Rig()
    base = np.array(rig.truth.world_from_base)
    assert base[:3, 3] == pytest.approx([0, 0, 0], abs=1e-3)
    assert base[:3, :3] == pytest.approx(np.eye(3), abs=0.01)
    wheels = [rig.world.data.body(f"wheel_{side}").xpos for side in ("left", "right")]
    middle = (wheels[0] + wheels[1]) / 2
    assert middle[:2] == pytest.approx(base[:2, 3], abs=2e-4)


def test_wheels_slip_when_the_robot_pushes_a_wall() -> None:
    wall = Scene.model_validate({"title": "wall", "room": {"x": (-1, 0.6), "y": (-1, 1)}})
    rig = Rig(wall)
    rig.drive(0.25, 0.0, 5.0)
    assert rig.pose.x < 0.6
    assert rig.reading.world_from_base.x > rig.pose.x + 0.1, "the encoders count on while the robot stands"


def test_deadman_stops_the_wheels_of_a_silent_host_in_time() -> None:
    rig = Rig()
    rig.drive(0.3, 0.0, 1.5)
    rig.step(15)  # 150 ms
    assert min(rig.wheel_speeds()) > 5.0, "not before its time"
    rig.step(1)
    assert rig.world.data.ctrl[rig.world.model.actuator("motor_left").id] == 0.0
    rig.step(30)
    assert np.abs(rig.wheel_speeds()).max() < 0.05
    stood = rig.pose.x
    rig.step(50)
    assert rig.pose.x == pytest.approx(stood, abs=1e-3)


def test_after_the_deadman_only_a_zero_unlocks_the_wheels() -> None:
    rig = Rig()
    rig.drive(0.3, 0.0, 0.5)
    rig.step(40)
    assert rig.world.board_state().needs_zero
    rig.drive(0.3, 0.0, 0.5)
    assert np.abs(rig.wheel_speeds()).max() < 0.05
    rig.world.drive(Twist(0.0, 0.0))
    rig.drive(0.3, 0.0, 0.5)
    assert not rig.world.board_state().needs_zero
    assert min(rig.wheel_speeds()) > 3.0


def test_a_twist_that_is_not_finite_stops() -> None:
    rig = Rig()
    rig.drive(0.2, 0.0, 0.5)
    rig.drive(math.nan, math.inf, 0.5)
    assert np.abs(rig.wheel_speeds()).max() < 0.05


def test_board_limits_what_the_host_asks() -> None:
    rig = Rig()
    rig.drive(3.0, 0.0, 2.0)
    assert rig.reading.twist.linear == pytest.approx(ROBOT.base.max_linear, abs=0.03)


def test_same_seed_gives_the_same_motion_and_another_does_not() -> None:
    ends = []
    for seed in (4, 4, 5):
        rig = Rig(faults={"slip_noise": 0.02}, seed=seed)
        rig.drive(0.2, 0.4, 1.0)
        ends.append((rig.world.snapshot(), rig.reading.world_from_base))
    assert np.array_equal(ends[0][0], ends[1][0])
    assert ends[0][1] == ends[1][1]
    assert ends[0][1] != ends[2][1]


def test_servos_keep_their_speed_limit_and_arrive() -> None:
    rig = Rig()
    rig.world.move_arm(ArmPose(1.0, 0.2, 0.6, 0.05))
    most = math.radians(ROBOT.arm.speed_deg_s)
    joint = rig.world.data.joint("rotation")
    fastest = 0.0
    for _ in range(20):
        before = float(joint.qpos[0])
        rig.step()
        fastest = max(fastest, (float(joint.qpos[0]) - before) / 0.01)
    assert rig.world.board_state().arm_is_moving
    assert 0.5 * most < fastest < 1.25 * most
    rig.step(150)
    state = rig.world.board_state()
    assert not state.arm_is_moving
    assert state.arm == ArmPose(1.0, 0.2, 0.6, 0.05)
    reached = [float(rig.world.data.joint(name).qpos[0]) for name in ("rotation", "shoulder", "elbow")]
    assert reached == pytest.approx([1.0, 0.2, 0.6], abs=math.radians(2.0))
    fingers = sum(float(rig.world.data.joint(f"finger_{side}").qpos[0]) for side in ("left", "right"))
    assert fingers == pytest.approx(0.05, abs=0.004)


def test_claw_stays_level_while_the_arm_stretches() -> None:
    rig = Rig()
    for shoulder, elbow in ((0.3, 0.4), (1.2, 0.1), (-0.4, 1.2)):
        rig.world.move_arm(ArmPose(0.0, shoulder, elbow, 0.03))
        rig.step(150)
        level = np.array(rig.truth.world_from_gripper)[2, 0]
        assert abs(level) < math.sin(math.radians(2.5))


def test_gripper_is_where_the_robot_file_says() -> None:
    rig = Rig()
    arm = ROBOT.arm
    rig.world.move_arm(ArmPose(0.5, 0.4, 0.3, 0.03))
    rig.step(200)
    reach = arm.upper_length * math.sin(0.4) + arm.fore_length * math.cos(0.7) + arm.hand_length
    height = arm.shoulder_up + arm.upper_length * math.cos(0.4) - arm.fore_length * math.sin(0.7)
    expected = (
        arm.shoulder_forward + reach * math.cos(0.5),
        arm.shoulder_left + reach * math.sin(0.5),
        height,
    )
    gripper = np.linalg.inv(rig.truth.world_from_base) @ np.array(rig.truth.world_from_gripper)
    assert gripper[:3, 3] == pytest.approx(expected, abs=0.006)


def test_claw_picks_a_can_up_by_friction_and_holds_it_while_driving() -> None:
    can = {"kind": "can", "name": "can", "position": (0.302, -0.045)}
    scene = Scene.model_validate({"title": "can", "room": HALL.room.model_dump(), "objects": [can]})
    rig = Rig(scene)
    for pose, periods in (
        (ArmPose(0.0, 0.25, 0.62, 0.072), 120),
        (_arm_at(0.225, 0.06, 0.072), 150),
        (_arm_at(0.302, 0.06, 0.072), 150),
        (_arm_at(0.302, 0.06, 0.050), 120),
        (_arm_at(0.250, 0.15, 0.050), 150),
    ):
        rig.world.move_arm(pose)
        rig.step(periods)
    lifted = rig.truth.object("can").centre_in_world[2]
    assert lifted > 0.0575 + 0.05
    rig.drive(-0.2, 0.0, 1.0)
    rig.drive(0.0, 0.8, 1.0)
    rig.step(30)
    assert rig.truth.object("can").centre_in_world[2] == pytest.approx(lifted, abs=0.005)
    assert not rig.world.warnings


def _arm_at(forward: float, up: float, claw: float) -> ArmPose:
    """Closed form for the level claw; forward and up of the gripper on the base, straight ahead."""
    arm = ROBOT.arm
    x, z = forward - arm.hand_length - arm.shoulder_forward, up - arm.shoulder_up
    a, b = arm.upper_length, arm.fore_length
    bend = math.acos((x * x + z * z - a * a - b * b) / (2 * a * b))
    upper = math.atan2(z, x) + math.atan2(b * math.sin(bend), a + b * math.cos(bend))
    shoulder = math.pi / 2 - upper
    return ArmPose(0.0, shoulder, bend - upper - shoulder, claw)


def test_broken_physics_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its log where it stands
    rig = Rig()
    assert rig.world.warnings == []
    rig.world.data.qvel[0] = math.nan
    rig.world.step()
    assert any("the physics reported" in warning for warning in rig.world.warnings)


def test_a_minute_of_rough_driving_leaves_the_physics_sound() -> None:
    rig = Rig()
    rng = np.random.default_rng(1)
    for _ in range(60):
        linear, angular = rng.uniform(-0.35, 0.35), rng.uniform(-1.5, 1.5)
        rig.world.move_arm(ArmPose(*rng.uniform([-1.3, -0.8, -0.9, 0.0], [1.3, 1.6, 1.6, 0.07])))
        rig.drive(linear, angular, 0.5)
    assert not rig.world.warnings
    assert np.isfinite(rig.world.snapshot()).all()
    assert abs(np.array(rig.truth.world_from_base)[2, 3]) < 0.03, "still on its wheels"
