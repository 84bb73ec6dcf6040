"""The same over real lines: a pseudo-terminal that is unplugged, and a TCP server that hangs up."""

import asyncio

import pytest
from tests.drivers.arduino.lines import PtyLine, TcpLine
from tests.drivers.arduino.peer import PeerBoard
from tests.drivers.arduino.rig import PeeredRobot, description_for, framed_robot, until

from tapreach.drivers.arduino.parts import NoCamera
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.messages import STILL, LinkStatus, Twist

pytestmark = pytest.mark.flaky(reruns=1)  # real lines and the real clock, as the tests of sockets


def drive_or_hear(robot, twist):
    if robot.health.is_running:
        robot.base.drive(twist)


async def drives(robot, readings):
    """Drive until it has moved 5 cm from here; a zero first, and again where a busy machine tripped it."""
    robot.base.drive(STILL)
    start = readings[-1].distance
    tries = iter(range(10**6))
    await until(
        lambda: readings[-1].distance > start + 0.05,
        lambda: drive_or_hear(robot, STILL if next(tries) % 25 == 0 else Twist(0.2, 0.0)),
    )


def test_cable_that_is_pulled_in_a_drive_is_said_and_comes_back_by_itself(tmp_path):
    async def run():
        robot, board = framed_robot(tmp_path / "board")
        readings, healths = [], []
        robot.base.subscribe(readings.append)
        robot.subscribe_health(healths.append)
        await robot.connect()
        await until(lambda: robot.health.is_running)
        await drives(robot, readings)
        robot.line.unplug()
        await until(lambda: robot.health.status is LinkStatus.LOST)
        await until(lambda: any("is not there: plug the board in" in h.reason for h in healths))
        assert any("was unplugged" in h.reason for h in healths)
        robot.line.plug()
        await until(lambda: robot.health.is_running)
        await drives(robot, readings)
        await robot.close()
        assert board.boot_id == 7

    asyncio.run(run())


def test_serial_server_that_hangs_up_is_called_again():
    async def run():
        clock = MonotonicClock()
        line = TcpLine(PeerBoard(clock))
        await line.open()
        await line.close()  # now its port is known and refused
        robot = PeeredRobot(line, description_for(line.address), clock, lambda *_: NoCamera())
        readings, healths = [], []
        robot.base.subscribe(readings.append)
        robot.subscribe_health(healths.append)
        await robot.connect()
        await until(lambda: robot.health.is_running)
        await drives(robot, readings)
        line.hang_up()
        await until(lambda: robot.health.status is LinkStatus.LOST)
        assert "closed the connection" in robot.health.reason
        await until(lambda: robot.health.is_running)
        await robot.close()

    asyncio.run(run())


def test_pseudo_terminal_carries_every_byte(tmp_path):
    async def run():
        robot, _ = framed_robot(tmp_path / "board")
        await robot.connect()
        await until(lambda: robot.health.is_running)
        assert isinstance(robot.line, PtyLine)
        await until(lambda: robot._board.session._reader.good_frames > 60)
        assert robot._board.session.bad_frames == 0
        await robot.close()

    asyncio.run(run())
