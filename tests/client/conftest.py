"""The real server on loopback around the fake robot, and scripts that talk to it."""

import asyncio
import contextlib
from collections.abc import Awaitable
from typing import TypeVar

import pytest
from tests.server import conftest as server

from tapreach.client.remote_robot import RemoteRobot, connect
from tapreach.robot.clock import MS

description = server.description
play = server.play
T = TypeVar("T")
PLACE = (320.0, 300.0)
"""Floor in the fake robot's picture [px]."""
TRUSTED_NS = 140 * MS
"""Silence of a script after which its next heartbeat is waited for; 200 ms stop the robot."""
PATIENCE_S = 150.0
"""Bound of a wait in which things are located in pictures; only reached when something is broken."""


async def turned_by_beats(here: server.Served, work: Awaitable[T]) -> T:
    """Return what `work`, a script in another thread or process, comes to. The robot's clock goes no faster
    than heartbeats come, so that the script is heard in time on however slow a machine.
    """
    doing = asyncio.ensure_future(work)
    deadman = here.station.deadman
    async with asyncio.timeout(PATIENCE_S):
        while not doing.done():
            await asyncio.sleep(0.001)
            silence_ns = here.clock.now_ns() - (deadman._heard_ns or 0)
            if silence_ns < TRUSTED_NS or not deadman.is_alive:
                await here.clock.advance(20 * MS)
    return doing.result()


class Script:
    """A script's robot on the test's clock, which is turned while the script waits."""

    def __init__(self, here: server.Served, robot: RemoteRobot) -> None:
        self.here = here
        self.robot = robot
        self.task = here.station.tasks

    async def turned(self, work: Awaitable[T]) -> T:
        """Return what `work` returns, turning the clock meanwhile, no faster than the socket carries."""
        doing = asyncio.ensure_future(work)
        async with asyncio.timeout(PATIENCE_S):
            while not doing.done():
                await self.robot.link.ask("ping", client_ms=self.here.clock.now_ns() / MS)
                await self.here.clock.advance(20 * MS)
        return doing.result()

    async def turn(self, duration_ns: int) -> None:
        """Turn the clock, no faster than the socket carries."""
        for _ in range(duration_ns // (20 * MS)):
            await self.turned(asyncio.sleep(0))

    async def fetching(self, mode="go"):
        """Begin to fetch something from the newest picture."""
        shot = await self.robot.snapshot()
        return await self.turned(self.robot.fetch(shot.frame_id, *PLACE, mode=mode))


@pytest.fixture
def script():
    """Return `async with script(here) as it`: a script that drives the robot."""

    @contextlib.asynccontextmanager
    async def connected(here, **arguments):
        async with connect(f"http://{here.host}/", clock=here.clock, **arguments) as robot:
            await here.clock.advance(50 * MS)
            yield Script(here, robot)

    return connected
