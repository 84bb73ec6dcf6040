"""What every Robot does, whatever it is made of (robot/interface.py)."""

import asyncio
import math
from itertools import pairwise

import cv2
import numpy as np
import pytest

from tapreach.errors import LinkLost
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import STILL, ArmPose, LinkStatus, Twist


def test_robot_that_is_not_connected_is_starting_and_takes_no_command(make_rig):
    robot = make_rig().robot
    assert robot.health.status is LinkStatus.STARTING
    with pytest.raises(LinkLost):
        robot.base.drive(STILL)
    with pytest.raises(LinkLost):
        robot.arm.move(robot.description.arm.standard.pose())


def test_connected_robot_runs_and_says_so(play):
    async def scenario(rig):
        assert rig.robot.health.is_running
        assert [health.status for health in rig.heard.health][-1] is LinkStatus.RUNNING

    play(scenario)


def test_odometry_begins_at_the_origin_and_comes_often_with_rising_times(play):
    async def scenario(rig):
        assert math.hypot(*pose_of(rig)[:2]) < 0.01
        count = len(rig.heard.odometry)
        await rig.until(lambda: len(rig.heard.odometry) >= count + 20)
        times = [reading.captured_ns for reading in rig.heard.odometry]
        intervals = sorted(later - earlier for earlier, later in pairwise(times))
        assert intervals[0] > 0
        # Half of them: a process of its own may be starved for a while.
        assert intervals[len(intervals) // 2] <= SECOND / 30
        assert times[-1] <= rig.clock.now_ns()

    play(scenario)


def pose_of(rig):
    pose = rig.heard.odometry[-1].world_from_base
    return pose.x, pose.y, pose.heading


def test_driving_forward_moves_along_the_heading(play):
    async def scenario(rig):
        assert rig.robot.base.drive(Twist(0.2, 0.0)) == Twist(0.2, 0.0)
        await rig.until(lambda: pose_of(rig)[0] > 0.15, Twist(0.2, 0.0))
        assert rig.heard.odometry[-1].twist.linear == pytest.approx(0.2, abs=0.05)
        await rig.rest()
        x, y, _ = pose_of(rig)
        assert 0.15 < x < 0.3
        assert abs(y) < 0.02
        assert rig.heard.odometry[-1].distance == pytest.approx(x, abs=0.01)

    play(scenario)


def test_positive_angular_speed_turns_left(play):
    async def scenario(rig):
        await rig.until(lambda: pose_of(rig)[2] > 0.5, Twist(0.0, 0.8))
        await rig.rest()
        x, y, _ = pose_of(rig)
        assert math.hypot(x, y) < 0.03

    play(scenario)


def test_too_fast_a_twist_is_limited_and_the_answer_says_to_what(play):
    async def scenario(rig):
        limits = rig.robot.description.base
        sent = rig.robot.base.drive(Twist(10.0, -50.0))
        assert 0.0 <= sent.linear <= limits.max_linear
        assert -limits.max_angular <= sent.angular < 0.0
        rig.robot.base.drive(STILL)

    play(scenario)


def test_base_stops_by_itself_when_the_host_falls_silent(play):
    async def scenario(rig):
        await rig.until(lambda: rig.heard.odometry[-1].distance > 0.1, Twist(0.2, 0.0))
        moving = rig.heard.odometry[-1].distance
        await rig.until(lambda: rig.heard.odometry[-1].twist.is_zero)
        stopped = rig.heard.odometry[-1].distance
        # 150 ms at 0.2 m/s are 30 mm; the rest is for motors that run down.
        assert stopped - moving < 0.06
        await rig.pass_time(500 * MS)
        assert rig.heard.odometry[-1].distance == pytest.approx(stopped, abs=0.002)

    play(scenario)


def test_base_moves_again_after_its_deadman_when_a_zero_has_come_first(play):
    async def scenario(rig):
        await rig.until(lambda: rig.heard.odometry[-1].distance > 0.02, Twist(0.2, 0.0))
        await rig.until(lambda: rig.heard.odometry[-1].twist.is_zero)
        stopped = rig.heard.odometry[-1].distance
        rig.robot.base.drive(STILL)
        await rig.until(lambda: rig.heard.odometry[-1].distance > stopped + 0.05, Twist(0.2, 0.0))
        rig.robot.base.drive(STILL)

    play(scenario)


def test_frames_are_numbered_from_one_and_decode_to_the_described_size(play):
    async def scenario(rig):
        await rig.until(lambda: len(rig.heard.frames) >= 5)
        camera = rig.robot.description.camera
        ids = [frame.frame_id for frame in rig.heard.frames]
        assert ids[0] >= 1
        assert ids == sorted(set(ids))
        for frame in rig.heard.frames:
            assert frame.captured_ns <= frame.received_ns <= rig.clock.now_ns()
            picture = cv2.imdecode(np.frombuffer(frame.jpeg, np.uint8), cv2.IMREAD_COLOR)
            assert picture.shape == (camera.height, camera.width, 3)
            assert (frame.size.width, frame.size.height) == (camera.width, camera.height)

    play(scenario)


def test_arm_goes_where_it_is_sent_and_reports_motion_and_rest(play):
    async def scenario(rig):
        target = rig.robot.description.arm.standard.pose()
        sent = rig.robot.arm.move(target)
        count = len(rig.heard.arm)
        await rig.until(lambda: not rig.heard.arm[-1].is_moving and len(rig.heard.arm) > count + 20)
        assert any(state.is_moving for state in rig.heard.arm[count:])
        assert rig.heard.arm[-1].target == sent
        pose = rig.heard.arm[-1].pose
        for name in ("rotation", "shoulder", "elbow"):
            assert getattr(pose, name) == pytest.approx(getattr(sent, name), abs=0.05)
        assert pose.claw == pytest.approx(sent.claw, abs=0.004)

    play(scenario)


def test_arm_target_beyond_the_joints_is_limited_and_the_answer_says_to_what(play):
    async def scenario(rig):
        section = rig.robot.description.arm
        sent = rig.robot.arm.move(ArmPose(9.0, -9.0, 9.0, 9.0))
        assert math.degrees(sent.rotation) <= section.rotation_limits_deg[1] + 1e-6
        assert math.degrees(sent.shoulder) >= section.shoulder_limits_deg[0] - 1e-6
        assert math.degrees(sent.elbow) <= section.elbow_limits_deg[1] + 1e-6
        assert sent.claw <= section.claw_max + 1e-9

    play(scenario)


def test_who_has_unsubscribed_hears_no_more(play):
    async def scenario(rig):
        heard = []
        unsubscribe = rig.robot.base.subscribe(heard.append)
        await rig.until(lambda: len(heard) >= 2)
        unsubscribe()
        unsubscribe()
        count, others = len(heard), len(rig.heard.odometry)
        await rig.until(lambda: len(rig.heard.odometry) > others + 5)
        assert len(heard) == count

    play(scenario)


def test_closed_robot_is_lost_takes_no_command_and_closes_twice(play):
    async def scenario(rig):
        await rig.robot.close()
        await rig.robot.close()
        assert rig.robot.health.status is LinkStatus.LOST
        assert rig.heard.health[-1].status is LinkStatus.LOST
        with pytest.raises(LinkLost):
            rig.robot.base.drive(Twist(0.1, 0.0))
        with pytest.raises(LinkLost):
            rig.robot.arm.move(rig.robot.description.arm.standard.pose())

    play(scenario)


def test_robot_that_was_never_connected_can_be_closed(make_rig):
    asyncio.run(make_rig().robot.close())
