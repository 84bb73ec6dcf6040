"""Lessons under the control loop, as the page starts them, with the firmware's own code as the board."""

import asyncio

import pytest
from tests.cli.test_teach import SHIPPED, Scripted, motor_answers
from tests.cli.test_teach_firmware import FirmwareBoard, needs_compiler
from tests.drivers.arduino.memory import ClockedRobot

from control.played import play as play_with
from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.control.pilot import MotionInterrupted
from tapreach.drivers.arduino.bench import PWM
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.config import load_robot
from tapreach.tasks.teaching.lesson import Lesson, find_out

pytestmark = needs_compiler
ANNA = 1


class Rig:
    """The compiled firmware under a running control loop; Anna holds the lease, and her task is admitted."""

    def __init__(self):
        clock = ManualClock()
        self.board = FirmwareBoard(clock)
        self.robot = ClockedRobot(self.board, clock)
        self.lease, self.deadman = Lease(clock), Deadman(clock)
        authority = Authority(self.robot, clock, self.lease, self.deadman, EmergencyStop(clock))
        self.loop = ControlLoop(authority)
        self.pilot = LoopPilot(self.loop, self.robot)
        self.is_there = True

    async def pass_time(self, duration_ns):
        for _ in range(duration_ns // (20 * MS)):
            if self.is_there:
                self.deadman.heard()
            await self.robot.pass_time(20 * MS)

    async def until(self, holds, most_ns=60 * SECOND):
        for _ in range(most_ns // (20 * MS)):
            if holds():
                return
            await self.pass_time(20 * MS)
        raise AssertionError("waited in vain")

    def holds(self, lesson, person):
        self.lease.request(ANNA)
        self.deadman.heard()
        self.loop.admit_task(ANNA)
        return asyncio.create_task(self._hold(lesson, person))

    async def _hold(self, lesson, person):
        description = load_robot(SHIPPED)
        async with self.robot.taught(description, self.pilot.carry_out) as bench:
            return await find_out(lesson, bench, person, description)


def play(scenario):
    play_with(Rig, scenario)


def test_motors_turn_gently_and_driving_goes_on_with_feedback_afterwards():
    async def scenario(rig):
        lesson = rig.holds(Lesson.MOTORS, Scripted(*motor_answers()))
        await rig.until(lesson.done)
        finding = lesson.result()
        assert (finding.to_wire, finding.changes) == ((), {})
        assert 0.8 * PWM < rig.board.most_pwm <= PWM + 2
        assert all(100 < angle < 1600 for angle in rig.board.board.angles)
        assert rig.board.board.pwm == (0, 0)

        turning = asyncio.ensure_future(rig.pilot.turn(0.5))
        await rig.until(turning.done)
        assert turning.result().world_from_base.heading > 0.4

    play(scenario)


def test_operator_who_falls_silent_takes_the_wheel_off():
    async def scenario(rig):
        lesson = rig.holds(Lesson.MOTORS, Scripted(*motor_answers()))
        await rig.until(lambda: any(rig.board.board.pwm))
        rig.is_there = False
        await rig.pass_time(260 * MS)
        assert rig.board.board.pwm == (0, 0)
        await rig.until(lesson.done)
        assert isinstance(lesson.exception(), MotionInterrupted)

    play(scenario)


def test_turns_by_hand_meet_no_motor_while_the_loop_sends_its_zeros():
    async def scenario(rig):
        lesson = rig.holds(Lesson.ENCODERS, Scripted("yes", "yes"))
        await rig.until(lesson.done)
        assert "check its supply" in str(lesson.exception())
        assert rig.board.most_pwm == 0

    play(scenario)


def test_servo_that_is_stopped_on_its_way_holds_there():
    async def scenario(rig):
        await rig.pass_time(100 * MS)
        lesson = rig.holds(Lesson.SERVOS, Scripted("yes", *["--"] * 20))
        await rig.until(lambda: 0 < rig.board.board.pulses[0] < 1400)
        rig.loop.stop("somebody pressed stop")
        lesson.cancel()
        held_us = rig.board.board.pulses[0]
        await rig.pass_time(2 * SECOND)
        assert rig.board.board.pulses[0] == pytest.approx(held_us, abs=8)
        assert rig.board.board.pulses[1:] == [0, 0, 0]
        assert lesson.cancelled()

    play(scenario)
