"""The page over the real drivers: what it says when camera or cable drop out, and that it comes back."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from playwright.async_api import Page, async_playwright, expect
from tests.server.real_drivers import RealRobot, real_robot
from tests.web.conftest import ARGUMENTS, CHROMIUM, TABLET

PATIENCE_MS = 20_000.0
LONGEST_MS = 2_000
"""Within which a drive has to have been stopped and said so."""


def play(folder: Path, scenario: Callable[[RealRobot, Page], Awaitable[None]]) -> None:
    """Run a scenario with somebody at the page; server, drivers and browser share one event loop."""

    async def run() -> None:
        async with real_robot(folder) as robot, async_playwright() as playwright:
            browser = await playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
            page = await browser.new_page(viewport={"width": TABLET[0], "height": TABLET[1]})
            troubles: list[str] = []
            page.on("pageerror", lambda error: troubles.append(str(error)))
            await page.add_init_script("localStorage.setItem('tapreach.hints', '3')")
            await page.goto(f"http://127.0.0.1:{robot.port}/")
            await may_drive(page)
            await scenario(robot, page)
            await browser.close()
            assert troubles == []

    asyncio.run(run())


async def may_drive(page: Page) -> None:
    await page.wait_for_selector("body:not(.cannot-drive)", timeout=PATIENCE_MS)
    await page.wait_for_selector("#lease-who:text-is('You')", timeout=PATIENCE_MS)


async def hold_until_it_moves(page: Page) -> None:
    await page.keyboard.down("w")
    await expect(page.locator("#motion")).to_contain_text("Forward", timeout=PATIENCE_MS)


async def drives_again(robot: RealRobot, page: Page) -> None:
    await page.keyboard.up("w")
    await may_drive(page)
    await expect(page.locator("#veil")).to_be_hidden(timeout=PATIENCE_MS)
    await hold_until_it_moves(page)
    assert robot.is_turning
    await page.keyboard.up("w")
    await expect(page.locator("#motion")).to_have_text("Still", timeout=PATIENCE_MS)


def test_dropped_camera_freezes_the_picture_stops_and_comes_back_by_itself(tmp_path: Path) -> None:
    async def scenario(robot: RealRobot, page: Page) -> None:
        await hold_until_it_moves(page)
        await robot.camera.kill()
        await expect(page.locator("#veil-title")).to_contain_text("FROZEN", timeout=LONGEST_MS)
        await expect(page.locator("#veil-text")).to_contain_text("127.0.0.1", timeout=LONGEST_MS)
        await expect(page.locator("#motion")).to_have_text("Still", timeout=LONGEST_MS)
        assert not robot.is_turning
        await robot.camera.start()
        await drives_again(robot, page)

    play(tmp_path, scenario)


def test_board_unplugged_during_a_drive_is_said_and_comes_back_by_itself(tmp_path: Path) -> None:
    async def scenario(robot: RealRobot, page: Page) -> None:
        await hold_until_it_moves(page)
        robot.line.unplug()
        await expect(page.locator("#veil-title")).to_have_text("Robot lost", timeout=LONGEST_MS)
        await expect(page.locator("#veil-text")).to_contain_text("lug the board in", timeout=LONGEST_MS)
        await expect(page.locator("#motion")).to_have_text("Still", timeout=LONGEST_MS)
        robot.line.plug()
        await drives_again(robot, page)

    play(tmp_path, scenario)
