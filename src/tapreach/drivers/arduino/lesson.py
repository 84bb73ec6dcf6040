"""A lesson under the running robot: its board is lent out, and gets back what it goes by."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

from tapreach.drivers.arduino.bench import SPIN_NS, BoardBench
from tapreach.drivers.arduino.board import FramedBoard
from tapreach.drivers.arduino.servos import ServoMap
from tapreach.drivers.arduino.wire import ToFirmware
from tapreach.drivers.arduino.wiring import wiring_of
from tapreach.errors import DriverError
from tapreach.robot.config import RobotDescription
from tapreach.robot.own_moves import OwnMove
from tapreach.robot.teachable import CarryOut


@asynccontextmanager
async def taught(
    board: FramedBoard, description: RobotDescription, carry_out: CarryOut
) -> AsyncIterator[BoardBench]:
    """See Teachable."""

    def begin_spin(left: int, right: int) -> OwnMove:
        return board.base.spin(left, right, SPIN_NS)

    rests = ServoMap(description.arm).pulses_us(description.arm.stowed.pose())
    board.lends_gains = True
    board.arm.begin_teaching()
    try:
        link = description.link
        await board.talk.require(wiring_of(link.reversed if link else ()))
        yield BoardBench(board.talk, begin_spin, carry_out, board.gains, rests)
    finally:
        await _give_back(board)


async def _give_back(board: FramedBoard) -> None:
    back: list[ToFirmware] = [board.wiring, *board.arm.end_teaching()]
    # Out of reach it is told the same when it is opened again.
    with suppress(DriverError):
        for message in back:
            await board.talk.require(message)
