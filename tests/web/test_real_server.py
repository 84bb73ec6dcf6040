"""The page with the real server and the fake robot, started by its command: drive, lease, tap."""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, TimeoutError
from tests.web.conftest import wait_ready

PATIENCE_MS = 30_000
MOVING = "#motion:text-matches('^Forward')"


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Run `tapreach run` with the fake robot on a free port."""
    captures = tmp_path_factory.mktemp("captures")
    command = [tapreach(), "run", "--robot", "fake", "--port", "0", "--captures", str(captures)]
    environment = os.environ | {"PYTHONUNBUFFERED": "1", "COLUMNS": "200"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stdout is not None
        lines = []
        for line in process.stdout:
            lines.append(line)
            if found := re.search(r"http://\S+", line):
                break
        else:
            pytest.fail(f"no address: {lines}")
        yield found.group(0)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)
        assert process.returncode == 0


def tapreach() -> str:
    """Return the command beside the interpreter that runs the tests."""
    beside = Path(sys.executable).with_name("tapreach")
    return str(beside) if beside.exists() else shutil.which("tapreach") or "tapreach"


@pytest.fixture
def open_real(browser: Browser, address: str) -> Iterator[Callable[..., Page]]:
    pages: list[Page] = []
    troubles: list[str] = []

    def open_real(is_driver: bool = True) -> Page:
        page = browser.new_page(viewport={"width": 1024, "height": 768})
        pages.append(page)
        page.set_default_timeout(PATIENCE_MS)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        # A content security policy that stops the page's own parts speaks on the console.
        page.on("console", lambda line: "Content Security" in line.text and troubles.append(line.text))
        page.add_init_script("localStorage.setItem('tapreach.hints', '3')")
        page.goto(address)
        if is_driver:
            wait_ready(page)
        return page

    yield open_real
    for page in pages:
        page.close()
    assert troubles == []


def hold_forward(driver: Page, watcher: Page) -> None:
    """Hold W until `watcher` shows that the robot moves; a picture that froze meanwhile needs a new press."""
    for _ in range(15):
        wait_ready(driver)
        driver.keyboard.down("w")
        try:
            watcher.wait_for_selector(MOVING, timeout=2000)
        except TimeoutError:
            driver.keyboard.up("w")
        else:
            return
    pytest.fail("the robot never moved")


def test_holding_drives_and_releasing_stands_still(open_real):
    page = open_real()
    before = page.locator("#odometry").inner_text()
    hold_forward(page, page)
    page.wait_for_selector(f"#odometry:not(:text-is('{before}'))")
    page.keyboard.up("w")
    page.wait_for_selector("#motion:text-is('Still')")


def test_stop_latches_and_resume_lets_drive_again(open_real):
    page = open_real()
    hold_forward(page, page)
    page.click("#stop")
    page.wait_for_selector("#stopped:not([hidden])")
    page.wait_for_selector("#motion:text-is('Still')")
    page.keyboard.up("w")
    page.click("#resume")
    wait_ready(page)


def test_the_lease_goes_from_one_page_to_the_other_by_asking(open_real):
    first = open_real()
    second = open_real(is_driver=False)
    second.wait_for_selector("#lease-action:text-is('Ask to drive')")
    second.click("#lease-action")
    first.click("#asked-grant")
    wait_ready(second)
    first.wait_for_selector("body.cannot-drive")
    hold_forward(second, second)
    second.keyboard.up("w")
    second.wait_for_selector("#motion:text-is('Still')")


def test_a_page_that_closes_while_driving_stops_the_robot(open_real):
    first = open_real()
    second = open_real(is_driver=False)
    hold_forward(first, second)
    first.close()
    second.wait_for_selector("#motion:text-is('Still')")
    wait_ready(second)


def test_a_capture_is_stored_listed_and_deleted(open_real):
    page = open_real()
    page.click("#capture")
    page.wait_for_selector("#captures-count:text-is('1')")
    page.click("#captures-open")
    picture = page.locator(".thumb img")
    assert picture.evaluate("picture => picture.decode().then(() => picture.naturalWidth)") == 640
    page.click(".thumb button")
    page.click(".thumb .button--stop")
    page.wait_for_selector("#captures-empty:not([hidden])")


def test_a_floor_guess_on_a_paused_picture_is_drawn_and_forgotten(open_real):
    page = open_real()
    page.click("#pause")
    page.wait_for_selector("body.is-paused")
    page.click("#purpose-floor")
    box = page.locator("#picture").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 0.7 * box["height"])
    page.wait_for_selector("#card:not([hidden])")
    assert re.fullmatch(r"[\d.]+ (cm|m)", page.locator("#card-range").inner_text())
    page.click("#card-close")
    page.wait_for_selector("#card", state="hidden")


def test_locating_starts_a_task_that_can_be_cancelled(open_real):
    page = open_real()
    box = page.locator("#picture").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + 0.6 * box["height"])
    page.click("#task-cancel")
    page.wait_for_selector("#task", state="hidden")
    page.wait_for_selector("#motion:text-is('Still')")


def test_the_guide_opens_and_ends(open_real):
    page = open_real()
    page.click("#menu-open")
    page.click("#guide-two-tap")
    page.wait_for_selector("#guide:not([hidden])")
    assert page.locator("#guide-step").inner_text().startswith("1 of ")
    page.click("#guide-close")
    page.wait_for_selector("#guide", state="hidden")
