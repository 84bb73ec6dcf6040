"""An operator in a process of its own, so that it can be stopped or killed in the middle of driving.

Drives at 20 Hz as the page does, and tells its parent when each drive message left.
"""

import argparse
import asyncio

from tapreach.bench.child import stdin_lines, tell_parent
from tapreach.bench.control_latency import watching_operator
from tapreach.robot.clock import MS, Clock, MonotonicClock
from tapreach.robot.messages import Twist

PERIOD_NS = 50 * MS


async def hold_drive(port: int, twist: Twist, clock: Clock) -> None:
    """Drive until cancelled, looking at the video as an operator does; tell when ready, then each message."""
    async with watching_operator(port, clock) as (client, viewing):
        tell_parent({"port": port})
        while True:
            # Told before it leaves: halted in between, the parent still knows of the last message.
            sent_ns = clock.now_ns()
            tell_parent({"sent_ns": sent_ns})
            await client.drive(twist, viewing.arrivals[-1].frame_id)
            await clock.sleep_until(sent_ns + PERIOD_NS)


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
