"""A scenario with a rig that has a robot and a control loop, both running."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Protocol, TypeVar

from tapreach.control.loop import ControlLoop
from tapreach.robot.clock import MS
from tapreach.robot.interface import Robot


class Rig(Protocol):
    """What a scenario is played with."""

    robot: Robot
    loop: ControlLoop

    async def pass_time(self, duration_ns: int) -> None: ...


R = TypeVar("R", bound=Rig)


def play(
    make_rig: Callable[[], R], scenario: Callable[[R], Awaitable[None]], after_ns: int = 200 * MS
) -> None:
    """Play it once the robot has been connected for `after_ns`; end all that runs."""

    async def run() -> None:
        rig = make_rig()
        await rig.robot.connect()
        running = asyncio.create_task(rig.loop.run())
        try:
            await rig.pass_time(after_ns)
            await scenario(rig)
        finally:
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)
            await rig.robot.close()

    asyncio.run(run())
