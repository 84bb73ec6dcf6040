"""The control loop with the fake robot and a clock turned by hand: every timeout, every way to be stopped."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from math import radians

import pytest

from control.played import play as play_with
from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman, Wish
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import PERIOD_NS, ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.control.pilot import MotionInterrupted
from tapreach.drivers.fake import FakeRobot
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import ArmPose, Twist

ANNA, BEN = 1, 2
FORWARD = Twist(0.2, 0.0)


class Rig:
    """A fake robot under a running control loop, with Anna holding the lease."""

    def __init__(self, description: RobotDescription) -> None:
        self.clock = ManualClock()
        self.robot = FakeRobot(description, self.clock, draws_in_thread=False)
        self.robot.frames.is_running = False
        self.lease = Lease(self.clock)
        self.deadman = Deadman(self.clock)
        self.emergency_stop = EmergencyStop(self.clock)
        authority = Authority(self.robot, self.clock, self.lease, self.deadman, self.emergency_stop)
        self.refusals: list[str] = []
        self.loop = ControlLoop(authority, self.refusals.append)
        self.pilot = LoopPilot(self.loop, self.robot)
        self.lease.request(ANNA)

    @property
    def speed(self) -> float:
        return self.robot.base.odometry.twist.linear

    def hold_forward(self) -> None:
        self.deadman.hold(Wish(FORWARD, self.clock.now_ns()))

    async def pass_time(self, duration_ns: int) -> None:
        await self.clock.advance(duration_ns)

    async def drive(self, duration_ns: int) -> None:
        """Hold forward at 20 Hz."""
        for _ in range(duration_ns // (50 * MS)):
            self.hold_forward()
            await self.clock.advance(50 * MS)

    async def operate(self, duration_ns: int) -> None:
        """Heartbeats only."""
        for _ in range(duration_ns // (50 * MS)):
            self.deadman.heard()
            await self.clock.advance(50 * MS)

    async def finished(self, awaitable: Awaitable[object], most_ns: int = 30 * SECOND) -> object:
        """Run a task's wish to its end under heartbeats, with Anna as the owner."""
        self.deadman.heard()
        self.loop.admit_task(ANNA)
        running = asyncio.ensure_future(awaitable)
        for _ in range(most_ns // (50 * MS)):
            await self.operate(50 * MS)
            if running.done():
                return running.result()
        raise AssertionError("not finished")


Scenario = Callable[[Rig], Awaitable[None]]


def play(description: RobotDescription, scenario: Scenario) -> None:
    play_with(lambda: Rig(description), scenario, PERIOD_NS)


def test_held_wish_moves_the_base(description):
    async def scenario(rig):
        await rig.drive(SECOND)
        assert rig.speed == pytest.approx(0.2)
        assert rig.robot.base.odometry.world_from_base.x > 0.1

    play(description, scenario)


def test_silence_stops_the_wheels_within_the_timeout_and_one_period(description):
    async def scenario(rig):
        await rig.drive(SECOND)
        await rig.clock.advance(120 * MS)
        assert rig.speed > 0.0
        await rig.clock.advance(50 * MS + 2 * PERIOD_NS)
        assert rig.speed == 0.0
        await rig.clock.advance(10 * SECOND)
        assert rig.speed == 0.0

    play(description, scenario)


def test_stop_sends_zero_at_once_without_waiting_for_the_loop(description):
    async def scenario(rig):
        await rig.drive(SECOND)
        assert rig.loop.stop("released").is_zero
        assert rig.loop.sent.twist.is_zero
        await rig.clock.advance(SECOND)
        assert rig.speed == 0.0

    play(description, scenario)


def test_ageing_picture_stops_a_wish_that_is_still_held(description):
    async def scenario(rig):
        captured_ns = rig.clock.now_ns()
        for _ in range(20):
            rig.deadman.hold(Wish(FORWARD, captured_ns))
            await rig.clock.advance(25 * MS)
        assert rig.speed > 0.0
        rig.deadman.hold(Wish(FORWARD, captured_ns))
        await rig.clock.advance(2 * PERIOD_NS)
        assert rig.speed == 0.0
        assert rig.loop.sent.limited_by.startswith("picture 5")

    play(description, scenario)


def test_emergency_stop_holds_the_wheels_whatever_is_wished(description):
    async def scenario(rig):
        rig.emergency_stop.press("Ben")
        await rig.drive(SECOND)
        assert rig.speed == 0.0
        assert "pressed by Ben" in rig.loop.sent.limited_by
        rig.emergency_stop.reset()
        await rig.drive(SECOND)
        assert rig.speed > 0.0

    play(description, scenario)


def test_zeros_are_sent_all_the_time(description):
    async def scenario(rig):
        sent = []
        plain_drive = rig.robot.base.drive
        rig.robot.base.drive = lambda twist: sent.append(twist) or plain_drive(twist)
        await rig.clock.advance(SECOND)
        assert len(sent) == 50
        assert all(twist.is_zero for twist in sent)

    play(description, scenario)


def test_stalled_loop_counts_overruns_and_does_not_catch_up(description):
    async def scenario(rig):
        await rig.clock.advance(200 * MS)
        sent = []
        plain_drive = rig.robot.base.drive
        rig.robot.base.drive = lambda twist: sent.append(twist) or plain_drive(twist)
        rig.clock.turn(SECOND)
        await rig.clock.advance(PERIOD_NS)
        assert rig.loop.overruns == 1
        assert len(sent) <= 2

    play(description, scenario)


def test_speeding_up_does_not_catch_up_on_a_stall(description):
    async def scenario(rig):
        rig.clock.turn(5 * SECOND)
        rig.hold_forward()
        assert rig.loop.act().linear <= 0.8 * 0.06 + 1e-9

    play(description, scenario)


def test_error_in_the_loop_ends_it_after_a_zero(description):
    async def scenario(rig):
        loop = ControlLoop(
            Authority(rig.robot, rig.clock, rig.lease, rig.deadman, rig.emergency_stop), rig.refusals.append
        )

        class Broken:
            moves_arm = False

            def step(self, senses, now_ns):
                raise ZeroDivisionError

        rig.deadman.heard()
        loop.admit_task(ANNA)
        motion = asyncio.ensure_future(loop.carry_out(Broken()))
        await asyncio.sleep(0)
        with pytest.raises(ZeroDivisionError):
            await loop.run()
        with pytest.raises(MotionInterrupted):
            await motion
        assert loop.sent.twist.is_zero

    play(description, scenario)


def test_task_turns_and_advances(description):
    async def scenario(rig):
        turned = await rig.finished(rig.pilot.turn(radians(30.0)))
        assert turned.world_from_base.heading == pytest.approx(radians(30.0), abs=radians(1.0))
        driven = await rig.finished(rig.pilot.advance(0.2))
        assert driven.world_from_base.x == pytest.approx(0.2 * 0.866, abs=0.005)
        assert rig.speed == 0.0
        assert rig.refusals == []

    play(description, scenario)


def test_one_move_sends_the_arm_turns_and_drives_to_about_there_and_sooner(description):
    async def scenario(rig):
        began_ns = rig.clock.now_ns()
        target = ArmPose(0.5, 0.1, 0.2, 0.02)
        driven = await rig.finished(rig.pilot.move(PlanarStep(radians(30.0), 0.2), target))
        together_ns = rig.clock.now_ns() - began_ns
        way = PlanarPose().between(driven.world_from_base)
        assert way.heading == pytest.approx(radians(30.0), abs=radians(3.0))
        assert math.hypot(way.x, way.y) == pytest.approx(0.2, abs=0.02)
        assert rig.speed == 0.0
        assert rig.robot.arm.state.pose == target
        began_ns = rig.clock.now_ns()
        await rig.finished(rig.pilot.move_arm(ArmPose(0.0, 0.1, 0.2, 0.02)))
        await rig.finished(rig.pilot.turn(radians(30.0)))
        await rig.finished(rig.pilot.advance(0.2))
        assert together_ns < 0.8 * (rig.clock.now_ns() - began_ns)

    play(description, scenario)


def test_move_too_short_to_start_the_wheels_for_ends_where_it_is(description):
    async def scenario(rig):
        reading = await rig.finished(rig.pilot.move(PlanarStep(radians(0.5), -0.004)))
        assert reading.world_from_base == PlanarPose()

    play(description, scenario)


def test_cancelled_move_stops_wheels_and_arm_at_once(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        target = ArmPose(0.5, 0.1, 0.2, 0.02)
        motion = asyncio.ensure_future(rig.pilot.move(PlanarStep(0.0, 0.5), target))
        await rig.operate(100 * MS)
        assert rig.loop.sent.twist.is_zero, "the arm goes first"
        motion.cancel()
        await asyncio.gather(motion, return_exceptions=True)
        assert rig.loop.arm_target != target
        rig.loop.move_arm(target)
        await rig.operate(SECOND)
        motion = asyncio.ensure_future(rig.pilot.move(PlanarStep(0.0, 0.5), target))
        await rig.operate(200 * MS)
        assert rig.loop.sent.twist.linear > 0.05, "at once with the arm where it should be"
        motion.cancel()
        await asyncio.gather(motion, return_exceptions=True)
        assert rig.loop.sent.twist.is_zero

    play(description, scenario)


def test_task_moves_the_arm_and_waits_for_it(description):
    async def scenario(rig):
        target = ArmPose(0.5, 0.1, 0.2, 0.02)
        await rig.finished(rig.pilot.move_arm(target))
        assert rig.robot.arm.state.pose == target

    play(description, scenario)


@pytest.mark.parametrize(
    ("interrupt", "reason"),
    [
        (lambda rig: rig.emergency_stop.press("Ben"), "emergency stop pressed by Ben"),
        (lambda rig: rig.lease.leave(ANNA), "lease"),
        (lambda rig: rig.deadman.gone(), "not heard"),
        (lambda rig: rig.robot.lose("cable out"), "cable out"),
        (lambda rig: rig.loop.stop("stopped (button)"), "stopped (button)"),
        (lambda rig: rig.loop.refuse_task("the operator drives"), "the operator drives"),
    ],
    ids=["emergency stop", "lease lost", "operator gone", "robot lost", "stop", "operator drives"],
)
def test_motion_of_a_task_is_ended_and_both_sides_are_told(description, interrupt, reason):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        motion = asyncio.ensure_future(rig.pilot.advance(2.0))
        await rig.operate(SECOND)
        assert rig.speed > 0.0
        interrupt(rig)
        rig.clock.turn(1)
        await rig.clock.advance(PERIOD_NS + 10 * MS)
        assert rig.speed == 0.0
        with pytest.raises(MotionInterrupted, match=reason.replace("(", r"\(").replace(")", r"\)")):
            await motion
        assert len(rig.refusals) == 1
        assert reason in rig.refusals[0]
        # and it stays so
        await rig.operate(SECOND)
        assert rig.speed == 0.0

    play(description, scenario)


def test_task_stops_when_the_heartbeats_stop(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        motion = asyncio.ensure_future(rig.pilot.advance(2.0))
        await rig.operate(SECOND)
        await rig.clock.advance(200 * MS)
        await rig.clock.advance(2 * PERIOD_NS)
        assert rig.speed == 0.0
        with pytest.raises(MotionInterrupted, match="not heard for 200 ms"):
            await motion

    play(description, scenario)


def test_task_without_admission_cannot_move(description):
    async def scenario(rig):
        with pytest.raises(MotionInterrupted, match="no task may move"):
            await rig.pilot.turn(0.1)

    play(description, scenario)


def test_task_of_a_session_without_the_lease_cannot_move(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(BEN)
        with pytest.raises(MotionInterrupted, match="lease"):
            motion = asyncio.ensure_future(rig.pilot.turn(0.1))
            await rig.operate(100 * MS)
            await motion

    play(description, scenario)


def test_cancelled_motion_stops_at_once_and_frees_the_pilot(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        motion = asyncio.ensure_future(rig.pilot.advance(2.0))
        await rig.operate(SECOND)
        motion.cancel()
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert rig.loop.sent.twist.is_zero
        assert (await rig.finished(rig.pilot.turn(0.1))).world_from_base.heading == pytest.approx(
            0.1, abs=radians(1.0)
        )

    play(description, scenario)


def test_arm_holds_where_it_is_when_its_motion_is_interrupted(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        motion = asyncio.ensure_future(rig.pilot.move_arm(ArmPose(1.5, 1.0, 0.0, 0.0)))
        await rig.operate(200 * MS)
        before = rig.robot.arm.state.pose
        assert rig.robot.arm.state.is_moving
        rig.loop.stop("stopped")
        await rig.clock.advance(SECOND)
        assert rig.robot.arm.state.pose.rotation == pytest.approx(before.rotation, abs=0.06)
        assert not rig.robot.arm.state.is_moving
        with pytest.raises(MotionInterrupted):
            await motion

    play(description, scenario)


def test_second_motion_beside_a_running_one_is_refused(description):
    async def scenario(rig):
        rig.deadman.heard()
        rig.loop.admit_task(ANNA)
        first = asyncio.ensure_future(rig.pilot.advance(1.0))
        await rig.operate(100 * MS)
        with pytest.raises(MotionInterrupted, match="not finished"):
            await rig.pilot.turn(0.5)
        first.cancel()

    play(description, scenario)
