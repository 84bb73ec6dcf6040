"""A robot and its peer by a clock that is turned by hand: bytes go over without a line, in order, at once."""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

from tests.drivers.arduino.peer import PeerBoard
from tests.drivers.arduino.rig import DrawnCamera, description_for

from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.robot.clock import MS, ManualClock
from tapreach.robot.messages import ArmState, Health, Odometry, Twist

STEP_NS = 5 * MS


class MemoryPort:
    """Both ends of a line."""

    def __init__(self, board: Any, hear: Any, end: Any) -> None:
        self._board, self.end = board, end
        board.write = hear

    def write(self, data: bytes) -> None:
        self._board.take(data)

    def close(self) -> None:
        self._board.write = lambda data: None


class ClockedRobot(ArduinoRobot):
    """Brings its peer; `connect` turns the clock until it is connected."""

    def __init__(self, board: Any, clock: ManualClock, file: str = "rover-pi", **link: Any) -> None:
        description = description_for("/dev/peer", file, **link)
        super().__init__(description, clock, DrawnCamera, self._open)
        self.board, self.clock = board, clock
        self.port: MemoryPort | None = None
        self.is_plugged = True
        self._steps: asyncio.Task[None] | None = None
        self.odometry: list[Odometry] = []
        self.healths: list[Health] = []
        self.arms: list[ArmState] = []

    def _open(self, section: Any, hear: Any, end: Any) -> MemoryPort:
        if not self.is_plugged:
            raise FileNotFoundError(2, "no such device")
        self.port = MemoryPort(self.board, hear, end)
        return self.port

    def unplug(self) -> None:
        self.is_plugged = False
        self.board.write = lambda data: None
        self.port.end(OSError(5, "Input/output error"))

    async def connect(self) -> None:
        self._steps = asyncio.create_task(self._step())
        connecting = asyncio.create_task(super().connect())
        while not connecting.done():
            await self.pass_time(10 * MS)
        await connecting

    async def pass_time(self, duration_ns: int) -> None:
        """Let time pass; opening and closing happen in real threads, so give them a real moment."""
        for _ in range(max(1, duration_ns // (10 * MS))):
            await self.clock.advance(10 * MS)
            await asyncio.sleep(0.0005 if not self._link.is_open else 0)

    async def until(self, holds: Any, each: Any = None, patience_s: float = 20.0) -> None:
        for _ in range(round(patience_s / 0.02)):
            if holds():
                return
            if each is not None:
                each()
            await self.pass_time(20 * MS)
        raise AssertionError("waited in vain")

    async def close(self) -> None:
        closing = asyncio.create_task(super().close())
        while not closing.done():
            await self.clock.advance(MS)
            await asyncio.sleep(0.0005)
        await closing
        if self._steps is not None:
            self._steps.cancel()
            with suppress(asyncio.CancelledError):
                await self._steps

    async def _step(self) -> None:
        while True:
            self.board.step()
            await self.clock.sleep_until(self.clock.now_ns() + STEP_NS)


async def play_on(robot: ClockedRobot, scenario: Callable[[Any], Awaitable[None]]) -> None:
    """Run a scenario on a connected robot that notes what it tells, and close it however that ends."""
    robot.base.subscribe(robot.odometry.append)
    robot.arm.subscribe(robot.arms.append)
    robot.subscribe_health(robot.healths.append)
    await robot.connect()
    assert robot.health.is_running
    try:
        await scenario(robot)
    finally:
        await robot.close()


async def drive(robot: ClockedRobot, twist: Twist, duration_ns: int) -> None:
    """Ask for a twist every 20 ms."""
    for _ in range(duration_ns // (20 * MS)):
        robot.base.drive(twist)
        await robot.pass_time(20 * MS)


def clocked_robot(**board: Any) -> ClockedRobot:
    clock = ManualClock()
    return ClockedRobot(PeerBoard(clock, **board), clock)
