"""Headless Chromium for the benches, and its clock beside ours."""

import contextlib
import os
import shutil
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from websockets.asyncio.server import ServerConnection, serve

from tapreach.errors import SetupError, TapreachError
from tapreach.robot.clock import MS, Clock

if TYPE_CHECKING:
    from playwright.async_api import Browser, Page

_CANDIDATES = ("chromium", "google-chrome", "google-chrome-stable", "chromium-browser")
_PROBE = Path(__file__).with_name("browser_probe.js")
_EXCHANGES = 100
_PATIENCE_MS = 60_000


class BrowserFailed(TapreachError):
    """The page did not do what was waited for."""


def chromium_path() -> str:
    """Return TAPREACH_CHROMIUM, or the first Chromium on the path. Raises SetupError when there is none."""
    named = os.environ.get("TAPREACH_CHROMIUM")
    for candidate in (named,) if named else _CANDIDATES:
        found = shutil.which(candidate)
        if found:
            return found
    raise SetupError(
        f"Chromium is needed to measure the page and {named or 'none'} was found: install chromium, "
        "or name a browser with TAPREACH_CHROMIUM=/path/to/chrome"
    )


@contextlib.asynccontextmanager
async def chromium() -> AsyncIterator["Browser"]:
    """Yield a headless Chromium. Raises SetupError, and BrowserFailed for what goes wrong in it later."""
    try:
        from playwright.async_api import Error, async_playwright
    except ImportError as error:
        raise SetupError("Playwright is needed to measure the page: pip install 'tapreach[dev]'") from error
    path = chromium_path()
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        try:
            yield browser
        except Error as error:
            raise BrowserFailed(f"Chromium: {error.message.splitlines()[0]}") from error
        finally:
            await browser.close()


@contextlib.asynccontextmanager
async def fresh_page(browser: "Browser", width: int = 1280, height: int = 800) -> AsyncIterator["Page"]:
    """Yield a page without a past, with the probe in it."""
    # The probe's clock socket is of another origin, which the operator page's policy forbids.
    context = await browser.new_context(viewport={"width": width, "height": height}, bypass_csp=True)
    try:
        context.set_default_timeout(_PATIENCE_MS)
        page = await context.new_page()
        await page.add_init_script(path=_PROBE)
        yield page
    finally:
        await context.close()


@contextlib.asynccontextmanager
async def chromium_page() -> AsyncIterator["Page"]:
    """Yield a page of a Chromium of its own. Raises SetupError."""
    async with chromium() as browser, fresh_page(browser) as page:
        yield page


@dataclass(frozen=True, slots=True)
class PageClock:
    """How a page's performance.now() [ms] translates to our clock."""

    offset_ns: int
    uncertainty_ms: float
    """Half of the shortest round trip: the offset cannot be wrong by more."""

    def our_ns(self, page_ms: float) -> int:
        """Translate a time of the page."""
        return self.offset_ns + round(page_ms * MS)


async def align_clock(page: "Page", clock: Clock) -> PageClock:
    """Exchange times with the page over a socket, and keep the fastest exchange."""

    async def answer(connection: ServerConnection) -> None:
        async for _ in connection:
            await connection.send(str(clock.now_ns()))

    async with serve(answer, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        rounds: list[list[Any]] = await page.evaluate(
            "([url, count]) => tapreachProbe.compareClocks(url, count)",
            [f"ws://127.0.0.1:{port}/", _EXCHANGES],
        )
    sent_ms, received_ms, told = min(rounds, key=lambda one: one[1] - one[0])
    middle_ns = round((sent_ms + received_ms) / 2 * MS)
    return PageClock(int(told) - middle_ns, (received_ms - sent_ms) / 2)
