"""A robot whose board moves by itself, under the control loop: what ends a task ends the board's move too."""

import asyncio
import math

import pytest
from tests.drivers.arduino.memory import clocked_robot

from control.played import play as play_with
from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.control.pilot import MotionInterrupted
from tapreach.drivers.arduino.wire import Drive, Fault, Keep, Move, Result, Stop
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, SECOND

ANNA = 1


class Rig:
    """A peer board under a running control loop, with Anna holding the lease and her task admitted."""

    def __init__(self):
        self.robot = clocked_robot()
        clock = self.robot.clock
        self.lease, self.deadman = Lease(clock), Deadman(clock)
        self.emergency_stop = EmergencyStop(clock)
        self.loop = ControlLoop(Authority(self.robot, clock, self.lease, self.deadman, self.emergency_stop))
        self.pilot = LoopPilot(self.loop, self.robot)
        self.task = None

    async def start(self, motion):
        self.lease.request(ANNA)
        self.deadman.heard()
        self.loop.admit_task(ANNA)
        self.task = asyncio.ensure_future(motion)
        await self.pass_time(20 * MS)

    async def pass_time(self, duration_ns):
        for _ in range(duration_ns // (20 * MS)):
            self.deadman.heard()
            await self.robot.pass_time(20 * MS)

    async def until(self, holds, most_ns=20 * SECOND):
        for _ in range(most_ns // (20 * MS)):
            if holds():
                return
            await self.pass_time(20 * MS)
        raise AssertionError("waited in vain")

    def asked(self, kind):
        return [message for message in self.robot.board.asked if isinstance(message, kind)]


def play(scenario):
    async def begun(rig):
        rig.robot.board.asked.clear()
        await scenario(rig)

    play_with(Rig, begun)


def test_turn_and_advance_are_one_command_each_and_no_drive_comes_between():
    async def scenario(rig):
        await rig.start(rig.pilot.turn(math.radians(50.0)))
        await rig.until(rig.task.done)
        turned = rig.task.result().world_from_base
        assert turned.heading == pytest.approx(math.radians(50.0), abs=0.005)
        await rig.start(rig.pilot.advance(0.3))
        await rig.until(rig.task.done)
        way = turned.between(rig.task.result().world_from_base)
        assert way.x == pytest.approx(0.3, abs=0.002)
        assert len(rig.asked(Move)) == 2
        assert len(rig.asked(Keep)) > 20
        assert all(message.left == message.right == 0 for message in rig.asked(Drive))
        assert not rig.asked(Stop)

    play(scenario)


def test_base_tells_how_far_the_boards_move_is_until_it_has_ended():
    async def scenario(rig):
        base, told = rig.robot.base, []
        assert base.own_move is None
        await rig.start(rig.pilot.move(PlanarStep(0.5, 0.2)))
        while not rig.task.done():
            told += [base.own_move.fraction] if base.own_move else []
            await rig.pass_time(20 * MS)
        assert told == sorted(told)
        assert told[0] < 0.05 and told[-1] > 0.95
        assert len(set(told)) > 20
        assert base.own_move is None

    play(scenario)


def test_share_slows_the_board_down():
    async def scenario(rig):
        await rig.start(rig.pilot.advance(0.1))
        await rig.until(rig.task.done)
        await rig.start(rig.pilot.advance(0.1, share=0.5))
        await rig.until(rig.task.done)
        usual, slow = (message.speed for message in rig.asked(Move))
        assert slow == pytest.approx(usual / 2, abs=1)

    play(scenario)


def test_step_is_two_moves_after_another():
    async def scenario(rig):
        await rig.start(rig.pilot.move(PlanarStep(0.5, 0.2)))
        await rig.until(rig.task.done)
        wanted, pose = PlanarStep(0.5, 0.2).to_pose(), rig.task.result().world_from_base
        assert (pose.x, pose.y, pose.heading) == pytest.approx(
            (wanted.x, wanted.y, wanted.heading), abs=0.003
        )

    play(scenario)


@pytest.mark.parametrize("ending", ["emergency stop", "lease", "stop", "cancel"])
def test_what_ends_a_task_stops_the_board(ending):
    async def scenario(rig):
        await rig.start(rig.pilot.advance(2.0))
        await rig.until(lambda: len(rig.asked(Keep)) > 10)
        if ending == "emergency stop":
            rig.emergency_stop.press("Ben")
        elif ending == "lease":
            rig.lease.leave(ANNA)
        elif ending == "stop":
            rig.loop.stop("released")
        else:
            rig.task.cancel()
        await rig.pass_time(60 * MS)
        assert rig.asked(Stop)
        with pytest.raises((MotionInterrupted, asyncio.CancelledError)):
            rig.task.result()
        ticks = rig.robot.board.telemetry().left
        await rig.pass_time(500 * MS)
        assert rig.robot.board.telemetry().left == ticks

    play(scenario)


def test_operator_who_falls_silent_stops_the_board():
    async def scenario(rig):
        await rig.start(rig.pilot.advance(2.0))
        await rig.until(lambda: len(rig.asked(Keep)) > 10)
        await rig.robot.pass_time(300 * MS)
        with pytest.raises(MotionInterrupted, match="operator not heard"):
            rig.task.result()
        assert rig.asked(Stop)

    play(scenario)


def test_move_that_a_fault_ends_is_given_up_with_the_reason():
    async def scenario(rig):
        await rig.start(rig.pilot.advance(2.0))
        await rig.until(lambda: len(rig.asked(Keep)) > 10)
        rig.robot.board.latch(Fault.ENCODER_STUCK)
        await rig.pass_time(200 * MS)
        with pytest.raises(MotionInterrupted, match="a fault stopped it"):
            rig.task.result()

    play(scenario)


def test_wheels_that_never_get_ready_are_given_up_with_the_reason():
    async def scenario(rig):
        rig.robot.board.refused[Drive] = Result.NEEDS_ZERO
        await rig.pass_time(300 * MS)
        await rig.start(rig.pilot.advance(0.5))
        await rig.until(rig.task.done)
        with pytest.raises(MotionInterrupted, match="wheels are not ready"):
            rig.task.result()

    play(scenario)
