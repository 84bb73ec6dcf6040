"""A protocol server and real Chromium for the page tests."""

import os
import shutil
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, Page, sync_playwright
from tests.web.protocol_server import ProtocolServer

CHROMIUM = os.environ.get("TAPREACH_CHROMIUM") or shutil.which("chromium") or "/usr/bin/chromium"
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
TABLET = (1024, 768)
OpenPage = Callable[..., Page]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def server() -> Iterator[ProtocolServer]:
    with ProtocolServer() as server:
        yield server


@pytest.fixture
def open_page(browser: Browser, server: ProtocolServer) -> Iterator[OpenPage]:
    """Open the page; `is_ready` waits until it holds the lease and paints. Errors in it fail the test."""
    contexts, troubles = [], []

    def open_page(
        size: tuple[int, int] = TABLET,
        scale: float = 1,
        is_ready: bool = True,
        hints: str = "3",
        url: str = "",
    ) -> Page:
        context = browser.new_context(
            viewport={"width": size[0], "height": size[1]}, device_scale_factor=scale, reduced_motion="reduce"
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(15_000)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        if hints:
            page.add_init_script(f"localStorage.setItem('tapreach.hints', '{hints}')")
        page.goto(url or server.url)
        if is_ready:
            wait_ready(page)
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert troubles == []


def wait_ready(page: Page) -> None:
    """Wait until the page may drive on sight."""
    page.wait_for_selector("body:not(.cannot-drive)")
    page.wait_for_selector("#lease-who:text-is('You')")
