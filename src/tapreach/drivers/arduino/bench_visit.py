"""The bench of a board that is visited alone: a person watches, nobody else moves it."""

from collections.abc import Callable

from tapreach.drivers.arduino.bench import SPIN_NS, BoardBench, gains_of
from tapreach.drivers.arduino.servos import ServoMap
from tapreach.drivers.arduino.talk import TICK_NS, Talk
from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.drivers.arduino.wheel_spin import WheelSpin
from tapreach.drivers.arduino.wire import Drive
from tapreach.errors import DriverError
from tapreach.robot.config import RobotDescription
from tapreach.robot.link_section import LinkSection
from tapreach.robot.own_moves import MoveStatus, OwnMove


def bench_of_visit(visit: BoardVisit, description: RobotDescription, link: LinkSection) -> BoardBench:
    """Return the bench; moves are carried out while their coroutine runs. Raises ConfigError."""
    talk = visit.talk

    def begin_spin(left: int, right: int) -> OwnMove:
        return WheelSpin(left, right, SPIN_NS, talk.session, talk.clock)

    async def carry_out(begin: Callable[[], OwnMove], moves_arm: bool = False) -> None:
        if not moves_arm:
            await talk.require(Drive(0, 0, talk.session.at_ms))
        await _kept(begin(), talk)

    rests = ServoMap(description.arm).pulses_us(description.arm.stowed.pose())
    return BoardBench(talk, begin_spin, carry_out, gains_of(link), rests)


async def _kept(move: OwnMove, talk: Talk) -> None:
    try:
        while move.status is MoveStatus.MOVING:
            move.keep()
            await talk.pause(TICK_NS)
    finally:
        move.cancel()
    if move.status is not MoveStatus.ARRIVED:
        raise DriverError(move.reason)
