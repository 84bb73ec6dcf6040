"""A real server around the real drivers: a board on a pseudo-terminal, a network camera on loopback."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path

from tests.drivers.arduino.lines import PtyLine
from tests.drivers.arduino.peer import PeerBoard
from tests.drivers.arduino.rig import description_for
from tests.drivers.camera.mjpeg_server import OK, MjpegServer, Visit
from tests.drivers.camera.pictures import part

from server.conftest import InlineService
from tapreach.drivers.arduino.factory import make_arduino_robot
from tapreach.drivers.fake_picture import FakePicture
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import RobotDescription
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, serve
from tapreach.server.station import Station

RATE_HZ = 25.0


class NetworkCamera:
    """An MJPEG server that can be killed, started again at the same port, and fall silent."""

    def __init__(self, description: RobotDescription) -> None:
        self.jpeg = FakePicture(description.camera).jpeg(PlanarPose(), "peer")
        self.is_silent = False
        self._server = MjpegServer(self._answer)
        self._running = contextlib.AsyncExitStack()

    @property
    def url(self) -> str:
        return self._server.url

    async def start(self) -> None:
        await self._running.enter_async_context(self._server.running())

    async def kill(self) -> None:
        await self._running.aclose()
        for visit in self._server.visits:
            visit.reset()

    async def _answer(self, visit: Visit) -> None:
        await visit.send(OK)
        while True:
            if not self.is_silent:
                await visit.send(part(self.jpeg))
            await asyncio.sleep(1.0 / RATE_HZ)


@dataclass
class RealRobot:
    """What a test does to it, and what the wheels do."""

    station: Station
    board: PeerBoard
    line: PtyLine
    camera: NetworkCamera
    port: int
    clock: MonotonicClock = field(default_factory=MonotonicClock)

    @property
    def is_turning(self) -> bool:
        return any(self.board.speeds) or self.board.state.name == "MOVING"


@contextlib.asynccontextmanager
async def real_robot(
    folder: Path, robot_file: Path | None = None, board_class: type[PeerBoard] = PeerBoard
) -> AsyncIterator[RealRobot]:
    """Serve it; the line and the camera are there from the beginning."""
    clock = MonotonicClock()
    board = board_class(clock, first_tick=0)
    line = PtyLine(board, folder / "board")
    described = description_for(line.address)
    camera = NetworkCamera(described)
    await line.open()
    await camera.start()
    section = described.camera.model_copy(update={"source": camera.url, "rate_hz": RATE_HZ})
    robot = make_arduino_robot(described.model_copy(update={"camera": section}), clock)
    station = Station(robot, clock, folder / "captures", InlineService(), robot_file)
    listener = listening_socket("127.0.0.1", 0)
    port = listener.getsockname()[1]
    ready = asyncio.Event()
    running = asyncio.create_task(serve(station, listener, AccessPolicy(), ready.set))
    waiting = asyncio.create_task(ready.wait())
    await asyncio.wait({running, waiting}, return_when=asyncio.FIRST_COMPLETED)
    if running.done():
        running.result()
    try:
        yield RealRobot(station, board, line, camera, port, clock)
    finally:
        running.cancel()
        await asyncio.gather(running, waiting, return_exceptions=True)
        await camera.kill()
        await line.close()
