"""A robot on a real line to a peer, that brings its peer with it."""

import asyncio
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.drivers.arduino.lines import PtyLine, TcpLine
from tests.drivers.arduino.peer import PeerBoard

from tapreach.drivers.arduino.parts import NoCamera
from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.drivers.fake_picture import FakePicture
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.resources import resource_path
from tapreach.robot.clock import MS, Clock, MonotonicClock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.messages import Frame

PATIENCE_S = 20.0


def description_for(address: str, file: str = "rover-pi", **link: Any) -> RobotDescription:
    described = load_robot(resource_path("robots") / f"{file}.toml")
    changed = described.link.model_copy(update={"address": address, **link})
    small = {"width": 160, "height": 120, "fx": described.camera.fx / 4, "source": None}
    camera = described.camera.model_copy(update=small)
    return described.model_copy(update={"link": changed, "camera": camera})


class DrawnCamera(NoCamera):
    """Tells the same drawn picture 20 times a second of its clock."""

    def __init__(self, description: RobotDescription, clock: Clock) -> None:
        super().__init__()
        self._section, self._clock = description.camera, clock
        self._task: asyncio.Task[None] | None = None

    def start(self) -> None:
        self._task = asyncio.create_task(self._run())

    async def close(self) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait([self._task])

    async def _run(self) -> None:
        jpeg = FakePicture(self._section).jpeg(PlanarPose(), "peer")
        size = ImageSize(self._section.width, self._section.height)
        for frame_id in range(1, 10**9):
            now_ns = self._clock.now_ns()
            self._listeners.tell(Frame(frame_id, now_ns, now_ns, size, jpeg))
            await self._clock.sleep_until(now_ns + 50 * MS)


class PeeredRobot(ArduinoRobot):
    """Opens its peer's line before it connects, and closes it last."""

    def __init__(
        self,
        line: PtyLine | TcpLine,
        description: RobotDescription,
        clock: MonotonicClock,
        make_camera: Any = DrawnCamera,
    ) -> None:
        super().__init__(description, clock, make_camera)
        self.line = line
        self._is_open = False

    async def connect(self) -> None:
        await self.line.open()
        self._is_open = True
        await super().connect()

    async def close(self) -> None:
        await super().close()
        if self._is_open:
            self._is_open = False
            await self.line.close()


def pty_path() -> Path:
    return Path(tempfile.mkdtemp(prefix="tapreach-")) / "board"


def framed_robot(path: Path) -> tuple[PeeredRobot, PeerBoard]:
    clock = MonotonicClock()
    board = PeerBoard(clock)
    line = PtyLine(board, path)
    return PeeredRobot(line, description_for(line.address), clock), board


async def until(holds: Callable[[], Any], each: Callable[[], Any] | None = None) -> None:
    """Wait, in bounds; call `each` every 20 ms as a control loop does."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds():
            if each is not None:
                each()
            await asyncio.sleep(0.02)
