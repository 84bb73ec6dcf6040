"""An operator in a process of its own, so that it can be stopped or killed in the middle of driving.

Drives at 20 Hz as the page does, and tells its parent when each drive message left.
"""

import argparse
import asyncio

from tapreach.bench.child import stdin_lines, tell_parent
from tapreach.bench.control_client import operator
from tapreach.bench.video_client import Viewing, view
from tapreach.robot.clock import MS, Clock, MonotonicClock
from tapreach.robot.messages import Twist

PERIOD_NS = 50 * MS


async def hold_drive(port: int, twist: Twist, clock: Clock) -> None:
    """Drive until cancelled, looking at the video as an operator does."""
    viewing = Viewing()
    watching = asyncio.create_task(view(port, viewing, clock))
    await viewing.first.wait()
    async with operator(port, clock) as client:
        tell_parent({"port": port})
        while True:
            answer = await client.drive(twist, viewing.arrivals[-1].frame_id)
            tell_parent({"sent_ns": answer.sent_ns, "is_ok": answer.is_ok})
            await clock.sleep_until(answer.sent_ns + PERIOD_NS)
    watching.cancel()


async def _run(port: int, linear: float) -> None:
    driving = asyncio.create_task(hold_drive(port, Twist(linear, 0.0), MonotonicClock()))
    lines = asyncio.create_task(_until_parent_ends())
    await asyncio.wait((driving, lines), return_when=asyncio.FIRST_COMPLETED)
    driving.cancel()
    await asyncio.gather(driving, return_exceptions=True)


async def _until_parent_ends() -> None:
    async for _ in stdin_lines():
        pass


def main() -> None:
    """Drive until stdin closes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("port", type=int)
    parser.add_argument("linear", type=float)
    given = parser.parse_args()
    asyncio.run(_run(given.port, given.linear))


if __name__ == "__main__":
    main()
