"""The driver with its peer, by a clock that is turned by hand."""

import asyncio
import math

import pytest
from tests.drivers.arduino.memory import clocked_robot, drive, play_on

from tapreach.drivers.arduino.frame_reader import encode
from tapreach.drivers.arduino.wire import (
    Ack,
    Drive,
    Fault,
    Move,
    Result,
    Reversed,
    ServoLimits,
    State,
    Stop,
    Wiring,
)
from tapreach.errors import DriverError, LinkLost
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import STILL, LinkStatus, Twist
from tapreach.robot.own_moves import MovesByItself, MoveStatus


def play(scenario, **board):
    async def run():
        await play_on(clocked_robot(**board), scenario)

    asyncio.run(run())


def test_odometry_goes_on_while_ticks_and_microseconds_wrap():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 3 * SECOND)
        newest = robot.odometry[-1]
        assert newest.world_from_base.x == pytest.approx(0.6, abs=0.03)
        assert abs(robot.clock.now_ns() - newest.captured_ns) < 45 * MS
        assert robot.board.ticks[0] > 2**31

    play(scenario, boot_us=2**32 - 1_000_000, first_tick=2**31 - 60)


def test_set_up_tells_the_board_its_servos_before_anything_moves():
    async def scenario(robot):
        limits = [m for m in robot.board.asked if isinstance(m, ServoLimits)]
        assert [m.index for m in limits] == [0, 1, 2, 3]
        assert all(m.low_us <= m.rest_us <= m.high_us for m in limits)
        assert robot.board.asked.index(Wiring(Reversed(0))) < robot.board.asked.index(limits[0])

    play(scenario)


def test_command_of_a_stalled_host_is_refused_as_too_old_by_its_time():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 200 * MS)
        (last,) = [m for m in robot.board.asked if isinstance(m, Drive)][-1:]
        await robot.pass_time(400 * MS)
        ticks = list(robot.board.ticks)
        robot.board.take(encode(Drive(0, 0, robot._board.session.at_ms), 1))
        robot.board.take(encode(last, 2))
        await robot.pass_time(100 * MS)
        assert robot.board.ticks == ticks

    play(scenario)


def test_stale_and_invented_acks_settle_nothing():
    async def scenario(robot):
        session = robot._board.session
        before = session.stale_answers
        robot.board.say(Ack(200, Result.OK))
        await robot.pass_time(20 * MS)
        assert session.stale_answers == before + 1
        robot.board.write, hear = lambda data: held.append(data), robot.board.write
        held = []
        robot.base.drive(STILL)
        robot.board.write = hear
        await robot.pass_time(300 * MS)
        for data in held:
            hear(data)
        await robot.pass_time(20 * MS)
        assert session.stale_answers > before + 1
        assert robot.health.is_running

    play(scenario)


def test_garbage_on_the_line_is_counted_and_nothing_else_happens():
    async def scenario(robot):
        rest = list(range(256)) * 3
        for start in range(0, 700, 7):
            robot.board.write(bytes(rest[start : start + 61]))
            await robot.pass_time(10 * MS)
        assert robot._board.session.bad_frames > 10
        assert robot.health.is_running
        await drive(robot, Twist(0.1, 0.0), 500 * MS)
        assert robot.odometry[-1].world_from_base.x > 0.02
        assert all(abs(reading.world_from_base.x) < 0.1 for reading in robot.odometry)

    play(scenario)


def test_reboot_in_a_drive_stops_says_why_and_goes_on_from_the_same_pose():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), SECOND)
        x = robot.odometry[-1].world_from_base.x
        robot.board.reboot()
        refusals = 0
        for _ in range(100):
            try:
                robot.base.drive(Twist(0.2, 0.0))
            except LinkLost:
                refusals += 1
            await robot.pass_time(20 * MS)
        assert refusals > 40
        assert robot.board.ticks == [0.0, 0.0]
        assert any("restarted: its supply broke down" in health.reason for health in robot.healths)
        assert robot.health.is_running
        assert robot.base.drive(Twist(0.2, 0.0)) == STILL  # no zero has been sent since
        robot.base.drive(STILL)
        await drive(robot, Twist(0.2, 0.0), SECOND)
        assert robot.odometry[-1].world_from_base.x == pytest.approx(x + 0.2, abs=0.04)

    play(scenario)


def test_unplugging_in_a_drive_is_said_and_replugging_goes_on_without_a_restart():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 500 * MS)
        robot.unplug()
        await robot.pass_time(300 * MS)
        assert robot.health.status is LinkStatus.LOST
        with pytest.raises(LinkLost, match=r"is not there: plug the board in|unplugged"):
            robot.base.drive(Twist(0.2, 0.0))
        await robot.pass_time(2 * SECOND)
        assert robot.board.state is State.TRIPPED
        robot.is_plugged = True
        await robot.until(lambda: robot.health.is_running)
        ticks = list(robot.board.ticks)
        await drive(robot, Twist(0.2, 0.0), 300 * MS)
        assert robot.board.ticks == ticks  # a zero has to come first
        robot.base.drive(STILL)
        await drive(robot, Twist(0.2, 0.0), 300 * MS)
        assert robot.board.ticks[0] > ticks[0] + 50

    play(scenario)


def test_other_protocol_version_is_refused_with_what_to_do():
    async def run():
        robot = clocked_robot()
        robot.board.version = 9
        await robot.connect()
        assert robot.health.status is LinkStatus.LOST
        assert "protocol version 9" in robot.health.reason
        with pytest.raises(LinkLost, match="version 9"):
            robot.base.drive(STILL)
        await robot.close()

    asyncio.run(run())


def test_mute_board_is_told_apart_from_one_that_is_not_there():
    async def run():
        robot = clocked_robot()
        robot.board.is_mute = True
        healths = []
        robot.subscribe_health(healths.append)
        await robot.connect()
        assert any("no Tapreach firmware answers" in health.reason for health in healths)
        robot.board.is_mute = False
        await robot.until(lambda: robot.health.is_running)
        await robot.close()

    asyncio.run(run())


def test_latched_fault_is_said_and_cleared_once_nobody_drives():
    async def scenario(robot):
        await drive(robot, Twist(0.2, 0.0), 200 * MS)
        robot.board.latch(Fault.ENCODER_STUCK)
        await drive(robot, Twist(0.2, 0.0), 3 * SECOND)
        assert "encoder counts nothing" in robot.health.reason
        assert robot.board.state is State.FAULTED
        assert robot.base.drive(Twist(0.2, 0.0)) == STILL
        await drive(robot, STILL, 3 * SECOND)
        assert robot.health.is_running
        assert robot.board.state is State.READY

    play(scenario)


async def follow(robot, move):
    await robot.until(lambda: move.status is not MoveStatus.MOVING, move.keep)


def test_step_is_two_moves_of_the_board_with_progress_and_an_exact_end():
    async def scenario(robot):
        assert isinstance(robot.base, MovesByItself)
        move = robot.base.drive_by(PlanarStep(math.radians(40.0), 0.25))
        fractions = []
        await robot.until(
            lambda: move.status is not MoveStatus.MOVING,
            lambda: (move.keep(), fractions.append(move.fraction)),
        )
        await robot.pass_time(60 * MS)
        assert move.status is MoveStatus.ARRIVED
        assert move.fraction == 1.0
        assert fractions == sorted(fractions)
        assert any(0.1 < fraction < 0.9 for fraction in fractions)
        wanted, pose = PlanarStep(math.radians(40.0), 0.25).to_pose(), robot.odometry[-1].world_from_base
        assert pose.heading == pytest.approx(wanted.heading, abs=0.005)
        assert math.hypot(pose.x - wanted.x, pose.y - wanted.y) < 0.002
        assert len([m for m in robot.board.asked if isinstance(m, Move)]) == 2

    play(scenario)


def test_move_that_nobody_keeps_is_stopped_by_the_board_and_says_so():
    async def scenario(robot):
        move = robot.base.drive_by(PlanarStep(0.0, 1.0))
        await robot.pass_time(SECOND)
        assert move.status is MoveStatus.FAILED
        assert "deadman" in move.reason
        assert robot.odometry[-1].distance < 0.05

    play(scenario)


def test_cancelled_move_stops_at_once_and_ends_once():
    async def scenario(robot):
        move = robot.base.drive_by(PlanarStep(0.0, 1.0))
        await robot.until(lambda: move.fraction > 0.1, move.keep)
        assert move.cancel("enough")
        assert not move.cancel("again")
        assert (move.status, move.reason) == (MoveStatus.CANCELLED, "enough")
        await robot.pass_time(60 * MS)
        distance = robot.odometry[-1].distance
        await robot.pass_time(300 * MS)
        assert robot.odometry[-1].distance == distance
        assert any(isinstance(m, Stop) for m in robot.board.asked)

    play(scenario)


def test_drive_in_a_move_ends_it():
    async def scenario(robot):
        move = robot.base.drive_by(PlanarStep(0.0, 1.0))
        await robot.until(lambda: move.fraction > 0.05, move.keep)
        assert robot.base.drive(Twist(0.1, 0.0)) == STILL
        assert move.status is MoveStatus.CANCELLED

    play(scenario)


def test_move_that_comes_too_late_is_asked_for_again_and_not_for_ever():
    async def scenario(robot):
        robot.board.refused[Move] = Result.TOO_OLD
        move = robot.base.drive_by(PlanarStep(0.0, 0.2))
        for _ in range(5):
            await robot.pass_time(20 * MS)
            move.keep()
        assert move.status is MoveStatus.MOVING
        del robot.board.refused[Move]
        await follow(robot, move)
        assert move.status is MoveStatus.ARRIVED
        robot.board.refused[Move] = Result.TOO_OLD
        move = robot.base.drive_by(PlanarStep(0.0, 0.2))
        await follow(robot, move)
        assert move.status is MoveStatus.FAILED
        assert "too late" in move.reason

    play(scenario)


def test_second_move_and_move_with_a_fault_are_refused_with_the_reason():
    async def scenario(robot):
        move = robot.base.drive_by(PlanarStep(0.0, 1.0))
        with pytest.raises(DriverError, match="another move is not finished"):
            robot.base.drive_by(PlanarStep(0.1, 0.0))
        move.cancel()
        await robot.pass_time(60 * MS)
        with pytest.raises(DriverError, match="send a zero first"):
            robot.base.drive_by(PlanarStep(0.1, 0.0))

    play(scenario)


def test_reboot_in_a_move_fails_it():
    async def scenario(robot):
        move = robot.base.drive_by(PlanarStep(0.0, 1.0))
        await robot.until(lambda: move.fraction > 0.05, move.keep)
        robot.board.reboot()
        await robot.pass_time(2 * SECOND)
        assert move.status is MoveStatus.FAILED

    play(scenario)


def test_servo_command_that_was_lost_is_sent_again():
    async def scenario(robot):
        robot.board.is_deaf = True
        sent = robot.arm.move(robot.description.arm.standard.pose())
        robot.board.is_deaf = False
        await robot.until(lambda: robot.arms[-1].target == sent and not robot.arms[-1].is_moving)
        assert robot.arms[-1].pose.elbow == pytest.approx(sent.elbow, abs=0.01)

    play(scenario)
