"""Teach-in through the server with a board on a pseudo-terminal, by the real clock."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from tests.drivers.arduino.wired import WiredBoard
from websockets.asyncio.client import connect

from server.conftest import Page
from server.real_drivers import RealRobot, real_robot
from server.test_dropouts import beat_until, health
from tapreach.drivers.arduino.wheels import FIRMWARE_GAINS
from tapreach.drivers.arduino.wire import Gains
from tapreach.resources import resource_path

SHIPPED = resource_path("robots") / "rover-pi.toml"


def spinning(folder: Path, scenario: Callable[[RealRobot, Page], Awaitable[None]]) -> None:
    """Run a scenario that begins while a lesson turns the left wheel."""
    own_file = folder / "rover.toml"
    own_file.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")

    async def run() -> None:
        async with real_robot(folder, own_file, WiredBoard) as here:
            page = Page(await connect(f"ws://127.0.0.1:{here.port}/ws/control", compression=None), here.clock)
            try:
                await page.ask("hello", name="Anna")
                assert (await page.ask("lease_request"))["ok"]
                await beat_until(here, page, lambda: health(page) == "running", None)
                assert (await page.act("heartbeat"))["ok"]
                assert (await page.ask("lesson_start", lesson="motors"))["ok"]
                for question_id in (1, 2):
                    asked = {"question_id": question_id, "question": True}
                    await beat_until(here, page, lambda asked=asked: is_asked(page, **asked), None)
                    assert (await page.ask("lesson_answer", question_id=question_id, answer="yes"))["ok"]
                await beat_until(here, page, lambda: here.is_turning, None)
                await scenario(here, page)
            finally:
                await page.close()

    asyncio.run(run())
    assert own_file.read_bytes() == SHIPPED.read_bytes()


def is_asked(page: Page, question_id: int, question: bool) -> bool:
    lesson = page.news.get("lesson", {"question_id": 0, "question": ""})
    return lesson["question_id"] == question_id and bool(lesson["question"]) is question


def gains_told(here: RealRobot) -> list[Gains]:
    return [message for message in here.board.asked if isinstance(message, Gains)]


def test_operator_who_vanishes_leaves_wheels_at_zero_and_the_board_its_gains(tmp_path: Path) -> None:
    async def scenario(here: RealRobot, page: Page) -> None:
        await page.close()
        async with asyncio.timeout(5):
            while here.is_turning or here.station.tasks.is_running:
                await asyncio.sleep(0.01)
        assert gains_told(here)[-1] == FIRMWARE_GAINS

    spinning(tmp_path, scenario)


def test_board_unplugged_ends_the_lesson_and_gets_its_gains_back_when_it_returns(tmp_path: Path) -> None:
    async def scenario(here: RealRobot, page: Page) -> None:
        here.line.unplug()
        await beat_until(here, page, lambda: page.news["lesson"]["ended"], None)
        assert page.news["lesson"]["ended"] == "cancelled"
        await beat_until(here, page, lambda: not here.is_turning, None)
        here.line.plug()
        await beat_until(here, page, lambda: health(page) == "running", None)
        assert gains_told(here)[-1] == FIRMWARE_GAINS

    spinning(tmp_path, scenario)
