"""The robot whose wheels and servos a microcontroller drives, with any camera."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

from tapreach.drivers.arduino.board import FramedBoard
from tapreach.drivers.arduino.lesson import taught as lesson_on
from tapreach.drivers.arduino.link import Link
from tapreach.drivers.arduino.parts import Board, CameraFactory
from tapreach.drivers.arduino.ports import OpenPort, open_port
from tapreach.drivers.arduino.ros_board import RosBoard
from tapreach.errors import ConfigError, DriverError
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.driver_robot import DriverRobot
from tapreach.robot.interface import Arm, Base, FrameSource, Unsubscribe
from tapreach.robot.messages import Health, LinkStatus
from tapreach.robot.teachable import Bench, CarryOut

TICK_NS = 10 * MS
CONNECT_NS = 5 * SECOND


class ArduinoRobot(DriverRobot):
    """See Robot. With protocol 'tapreach' its base is also a MovesByItself.

    `connect` waits up to 5 s for board and camera and returns in any case: what is missing is told by
    `health` and looked for until `close`, so that a cable may be plugged in later.
    """

    def __init__(
        self,
        description: RobotDescription,
        clock: Clock,
        make_camera: CameraFactory,
        open_port: OpenPort = open_port,
    ) -> None:
        if description.link is None:
            raise ConfigError("the robot file has no [link]: without it no board is known")
        super().__init__(description, "the link has not been opened")
        self._clock = clock
        framed = description.link.protocol == "tapreach"
        made = FramedBoard if framed else RosBoard
        self._board: Board = made(description, clock, self._write, self._take_board_health)
        hears = self._board.found, self._board.heard, self._lost
        self._link = Link(description.link, clock, *hears, open_port)
        self._camera = make_camera(description, clock)
        self.base: Base = self._board.base
        self.arm: Arm = self._board.arm
        self.frames: FrameSource = self._camera
        self._board_health = self.health
        self._tasks: list[asyncio.Task[None]] = []
        self._unsubscribe: Unsubscribe | None = None

    @property
    def can_be_taught(self) -> bool:
        """See Teachable."""
        return isinstance(self._board, FramedBoard)

    @asynccontextmanager
    async def taught(self, description: RobotDescription, carry_out: CarryOut) -> AsyncIterator[Bench]:
        """See Teachable."""
        if not isinstance(self._board, FramedBoard):
            raise DriverError("the board's firmware lacks what lessons need: flash Tapreach's own")
        async with lesson_on(self._board, description, carry_out) as bench:
            yield bench

    async def connect(self) -> None:
        """See Robot; raises nothing for what may still come."""
        self._unsubscribe = self._camera.subscribe_status(lambda _: self._tell())
        self._camera.start()
        work = (self._link.run(), self._tick())
        self._tasks = [asyncio.create_task(each, name="arduino robot") for each in work]
        for task in self._tasks:
            task.add_done_callback(self._on_end)
        end_ns = self._clock.now_ns() + CONNECT_NS
        while not self._health.is_running and self._clock.now_ns() < end_ns:
            await self._clock.sleep_until(self._clock.now_ns() + TICK_NS)

    async def close(self) -> None:
        """See Robot."""
        self._board.halt()
        tasks, self._tasks = self._tasks, []
        for task in tasks:
            task.cancel()
        for task in tasks:
            with suppress(asyncio.CancelledError):
                await task
        if self._unsubscribe is not None:
            self._unsubscribe()
            self._unsubscribe = None
        await self._camera.close()
        if tasks:
            self._board.lost("the robot was closed")

    async def _tick(self) -> None:
        while True:
            reason = self._board.tick()
            if reason and self._link.is_open:
                self._link.drop(reason)
            if self._board.is_serving:
                self._link.serves()
            await self._clock.sleep_until(self._clock.now_ns() + TICK_NS)

    def _write(self, data: bytes) -> None:
        self._link.write(data)

    def _lost(self, reason: str) -> None:
        self._board.lost(reason)

    def _take_board_health(self, health: Health) -> None:
        self._board_health = health
        self._tell()

    def _tell(self) -> None:
        health, camera = self._board_health, self._camera.status
        if health.is_running and not camera.is_running:
            health = Health(LinkStatus.LOST, camera.reason)
        self._set_health(health)

    def _on_end(self, task: "asyncio.Task[None]") -> None:
        if task.cancelled() or task.exception() is None:
            return
        # Nobody looks after the link any more: say so instead of standing with the last word.
        self._board.lost(f"the driver failed, start Tapreach again: {task.exception()!r}")
