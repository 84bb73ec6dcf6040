"""STOP during a lesson: the page over the real server, the real driver and a board on a line."""

import asyncio
import re
from pathlib import Path

from playwright.async_api import async_playwright, expect
from tests.drivers.arduino.wired import WiredBoard
from tests.server.real_drivers import real_robot
from tests.web.conftest import ARGUMENTS, CHROMIUM, TABLET
from tests.web.test_dropouts import PATIENCE_MS, may_drive

from tapreach.resources import resource_path

SHIPPED = resource_path("robots") / "rover-pi.toml"


def test_stop_during_a_lesson_takes_the_wheels_off_and_the_page_says_so(tmp_path: Path) -> None:
    own_file = tmp_path / "rover.toml"
    own_file.write_text(SHIPPED.read_text(encoding="utf-8"), encoding="utf-8")

    async def run() -> None:
        async with real_robot(tmp_path, own_file, WiredBoard) as robot, async_playwright() as playwright:
            browser = await playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
            page = await browser.new_page(viewport={"width": TABLET[0], "height": TABLET[1]})
            page.set_default_timeout(PATIENCE_MS)
            await page.add_init_script("localStorage.setItem('tapreach.hints', '3')")
            await page.goto(f"http://127.0.0.1:{robot.port}/")
            await may_drive(page)
            await page.click("#menu-open")
            await page.click("#menu-lessons")
            await page.click("#lesson-acts button:has-text('Motors')")
            question = page.locator("#lesson-question")
            for words in ("off the ground", "left wheel"):
                await expect(question).to_contain_text(words, timeout=PATIENCE_MS)
                await page.click("#lesson-acts button:has-text('Yes')")
            async with asyncio.timeout(20):
                while not robot.is_turning:
                    await asyncio.sleep(0.01)
            await page.click("#stop")
            await expect(page.locator("#lesson-state")).to_have_text("Stopped", timeout=PATIENCE_MS)
            stopped = re.compile("emergency stop", re.IGNORECASE)
            await expect(question).to_have_text(stopped, timeout=PATIENCE_MS)
            assert not robot.is_turning
            await browser.close()

    asyncio.run(run())
    assert own_file.read_bytes() == SHIPPED.read_bytes()
