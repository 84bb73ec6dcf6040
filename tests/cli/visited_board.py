"""A board that is visited, by a clock that runs as fast as it can."""

import asyncio

from tests.drivers.arduino.memory import MemoryPort
from tests.drivers.arduino.peer import PeerBoard

from tapreach.drivers.arduino.visit import BoardVisit
from tapreach.robot.clock import MS, ManualClock
from tapreach.robot.link_section import LinkSection

STEP_NS = 5 * MS


async def turn(clock, step):
    """Turn the clock for ever; what happens in real threads (opening a port) gets a moment."""
    while True:
        step()
        await clock.advance(STEP_NS)
        await asyncio.sleep(0)


def play_clocked(work, make_board=PeerBoard, open_port=None):
    """Run `work(clock, board, open_port)` while the clock turns and the board lives."""

    async def run():
        clock = ManualClock()
        board = make_board(clock)

        def opened(section, hear, end):
            return MemoryPort(board, hear, end)

        turning = asyncio.create_task(turn(clock, board.step))
        working = asyncio.create_task(work(clock, board, open_port or opened))
        await asyncio.wait({turning, working}, return_when=asyncio.FIRST_COMPLETED)
        if turning.done():
            working.cancel()
            turning.result()
        turning.cancel()
        return await working

    return asyncio.run(run())


def play_visit(scenario, make_board=PeerBoard, open_port=None):
    """Run `scenario(visit, board, clock)` with an entered visit; return what it returns."""

    async def work(clock, board, opened):
        async with BoardVisit(LinkSection(address="/dev/peer"), clock, (), opened) as visit:
            return await scenario(visit, board, clock)

    return play_clocked(work, make_board, open_port)
