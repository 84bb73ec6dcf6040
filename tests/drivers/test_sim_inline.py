import asyncio

import pytest
from sim_world import HALL, ROBOT

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.errors import LinkLost
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.messages import ArmPose, Frame, Health, LinkStatus, Odometry, Twist


def test_time_of_the_world_is_the_clock_of_the_test() -> None:
    async def scenario() -> None:
        clock = ManualClock()
        robot = InlineSimRobot(ROBOT, HALL, clock, has_pictures=False)
        readings: list[Odometry] = []
        robot.base.subscribe(readings.append)
        await robot.connect()
        for _ in range(100):
            robot.base.drive(Twist(0.2, 0.0))
            await clock.advance(20 * MS)
        assert len(readings) == pytest.approx(100, abs=1)
        assert readings[-1].captured_ns == pytest.approx(clock.now_ns(), abs=20 * MS)
        assert readings[-1].world_from_base.x == pytest.approx(0.38, abs=0.03)
        truth = await ask_truth(robot, readings[-1].captured_ns)
        assert truth.base_pose.x == pytest.approx(readings[-1].world_from_base.x, abs=0.005)
        await robot.close()
        assert robot.health.status is LinkStatus.LOST
        with pytest.raises(LinkLost):
            robot.base.drive(Twist(0.0, 0.0))

    asyncio.run(scenario())


def test_pictures_come_at_their_rate_with_rising_numbers_and_late_by_the_delay() -> None:
    async def scenario() -> None:
        clock = ManualClock()
        faults = load_scene("plain_floor").faults.merged({"camera_delay_ms": 60.0})
        robot = InlineSimRobot(ROBOT, load_scene("plain_floor"), clock, faults)
        frames: list[Frame] = []
        robot.frames.subscribe(frames.append)
        health: list[Health] = []
        robot.subscribe_health(health.append)
        start_ns = clock.now_ns()
        await robot.connect()
        assert health == [Health(LinkStatus.RUNNING)]
        await clock.advance(SECOND)
        assert [f.frame_id for f in frames] == list(range(1, len(frames) + 1))
        assert len(frames) == pytest.approx(28, abs=1)
        assert frames[0].received_ns - start_ns >= 60 * MS
        await robot.close()

    asyncio.run(scenario())


def test_arm_target_is_limited_to_the_joints() -> None:
    async def scenario() -> None:
        clock = ManualClock()
        robot = InlineSimRobot(ROBOT, HALL, clock, has_pictures=False)
        await robot.connect()
        sent = robot.arm.move(ArmPose(9.0, -9.0, 0.5, 9.0))
        assert sent == ArmPose(
            pytest.approx(1.396, abs=1e-3), pytest.approx(-0.873, abs=1e-3), 0.5, ROBOT.arm.claw_max
        )
        await robot.close()

    asyncio.run(scenario())
