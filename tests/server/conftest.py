"""A real server on loopback around the fake robot, its clock turned by the test, and a page to talk to it."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from tapreach.drivers.fake import FakeRobot
from tapreach.robot.clock import MS, Clock, ManualClock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.server.access import AccessPolicy
from tapreach.server.serve import listening_socket, serve
from tapreach.server.station import Station
from tapreach.tasks.compute import InlineCompute

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 20.0
"""Bound of every wait for real sockets; only reached when something is broken."""


class InlineService(InlineCompute):
    """Computes in place: tests need no process."""

    async def start(self) -> None: ...

    async def close(self) -> None: ...


class Page:
    """The other end of a control socket: numbers its requests, keeps the news by type."""

    def __init__(self, socket: ClientConnection, clock: Clock) -> None:
        self.socket = socket
        self.clock = clock
        self.seq = 0
        self.answers: dict[int | None, list[dict[str, Any]]] = {}
        self.news: dict[str, dict[str, Any]] = {}
        self._heard = asyncio.Condition()
        self._reader = asyncio.create_task(self._read())

    async def ask(self, type: str, **fields: Any) -> dict[str, Any]:
        """Send a request and return its answer."""
        self.seq += 1
        seq = self.seq
        await self.socket.send(json.dumps({"type": type, "seq": seq, **fields}))
        await self.until(lambda: seq in self.answers)
        return self.answers[seq][0]

    async def act(self, type: str, **fields: Any) -> dict[str, Any]:
        """Send a request that carries the page's clock; this page's clock runs with the server's."""
        return await self.ask(type, **{"client_ms": self.clock.now_ns() / MS, "frame_id": None} | fields)

    async def drive(self, linear: float = 0.2, angular: float = 0.0, **fields: Any) -> dict[str, Any]:
        """One drive message."""
        return await self.act("drive", linear=linear, angular=angular, **fields)

    async def until(self, holds: Callable[[], Any]) -> None:
        """Wait until something that was heard makes `holds` true."""
        async with asyncio.timeout(PATIENCE_S), self._heard:
            await self._heard.wait_for(holds)

    async def close(self) -> None:
        await self.socket.close()
        await self._reader

    async def _read(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            async for text in self.socket:
                message = json.loads(text)
                async with self._heard:
                    if message["type"] in ("ack", "pong", "welcome"):
                        self.answers.setdefault(message["seq"], []).append(message)
                    else:
                        self.news[message["type"]] = message
                    self._heard.notify_all()


class Served:
    """A running server, seen from the test."""

    def __init__(self, station: Station, robot: FakeRobot, clock: Any, port: int) -> None:
        self.station = station
        self.robot = robot
        self.clock = clock
        self.port = port
        self.host = f"127.0.0.1:{port}"
        self._pages: list[Page] = []

    @property
    def speed(self) -> float:
        """What the wheels do [m/s]."""
        return self.robot.base.odometry.twist.linear

    @property
    def newest_id(self) -> int:
        frame = self.station.frames.newest
        assert frame is not None
        return frame.frame_id

    async def page(self, name: str = "Anna", greet: bool = True) -> Page:
        page = Page(
            await connect(f"ws://{self.host}/ws/control", compression=None, close_timeout=1), self.clock
        )
        self._pages.append(page)
        if greet:
            await page.ask("hello", name=name)
        return page

    async def driver(self, name: str = "Anna") -> Page:
        """A page that holds the lease and has seen a picture."""
        page = await self.page(name)
        assert (await page.ask("lease_request"))["ok"]
        await self.clock.advance(50 * MS)
        return page

    async def hold(self, page: Page, duration_ns: int, linear: float = 0.2) -> None:
        """Hold the drive button as a page does: 20 Hz, always naming the newest picture."""
        for _ in range(duration_ns // (50 * MS)):
            assert (await page.drive(linear, frame_id=self.newest_id))["ok"]
            await self.clock.advance(50 * MS)

    async def beat(self, page: Page, duration_ns: int) -> None:
        """Only be there."""
        for _ in range(duration_ns // (50 * MS)):
            assert (await page.act("heartbeat", frame_id=self.newest_id))["ok"]
            await self.clock.advance(50 * MS)

    async def eventually(self, holds: Callable[[], Any]) -> None:
        """Wait, in real time and without turning the clock, until `holds`."""
        async with asyncio.timeout(PATIENCE_S):
            while not holds():
                await asyncio.sleep(0.002)

    async def leave(self) -> None:
        for page in self._pages:
            await page.close()


@pytest.fixture(scope="session")
def description() -> RobotDescription:
    return load_robot(ROOT / "robots" / "fake.toml")


@contextlib.asynccontextmanager
async def served(
    description: RobotDescription, folder: Path, clock: Clock, policy: AccessPolicy
) -> AsyncIterator[Served]:
    robot = FakeRobot(description, clock, draws_in_thread=not isinstance(clock, ManualClock))
    station = Station(robot, clock, folder / "captures", InlineService())
    listener = listening_socket("127.0.0.1", 0)
    port = listener.getsockname()[1]
    ready = asyncio.Event()
    running = asyncio.create_task(serve(station, listener, policy, ready.set))
    waiting = asyncio.create_task(ready.wait())
    await asyncio.wait({running, waiting}, return_when=asyncio.FIRST_COMPLETED)
    if running.done():
        running.result()
    here = Served(station, robot, clock, port)
    try:
        yield here
    finally:
        await here.leave()
        running.cancel()
        await asyncio.gather(running, waiting, return_exceptions=True)


@pytest.fixture
def play(description: RobotDescription, tmp_path: Path) -> Callable[..., None]:
    """Return a function that runs a scenario against a fresh server."""

    def run(
        scenario: Callable[[Served], Awaitable[None]],
        clock: Clock | None = None,
        policy: AccessPolicy | None = None,
    ) -> None:
        async def main() -> None:
            async with served(
                description, tmp_path, clock or ManualClock(), policy or AccessPolicy()
            ) as here:
                await scenario(here)

        asyncio.run(main())

    return run
