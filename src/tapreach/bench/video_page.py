"""Video in Chromium: the operator page against MJPEG in an <img>."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING
from urllib.request import urlopen

from tapreach.bench.browser import chromium, fresh_page
from tapreach.bench.child import started
from tapreach.bench.drawn import ages_ms, watch_drawing
from tapreach.bench.ending import finish
from tapreach.bench.figure import Figure, at_most
from tapreach.bench.painted import CANVAS, painted_ages_ms, watch_painting
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile
from tapreach.bench.served import PatternServer
from tapreach.bench.video_client import Viewing, view
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import SECOND, Clock

if TYPE_CHECKING:
    from playwright.async_api import Browser

_SHOW_STREAM = "document.body.innerHTML = '<img src=/stream.mjpg>'"


async def measure_page(
    server: PatternServer, rate_hz: float, seconds: float, seed: int, clock: Clock
) -> Section:
    """Measure the operator page, our own MJPEG and the plain MJPEG peer, each alone in the browser."""
    async with chromium() as browser:
        page_ages, rate = await _page(browser, server, seconds, clock)
        mjpeg_ages = await _mjpeg(browser, server, seconds, clock)
        peer_ages = await _peer(browser, server.size, rate_hz, seconds, seed, clock)
    interval_ms = 1000 / rate_hz
    return Section(
        f"Chromium, {server.size.width} x {server.size.height}",
        "Age: from capture to the animation frame in which the picture is drawn; on the operator page by the "
        "id on its canvas, since reading the canvas back would slow it down, in an <img> by the bar code. "
        "Plain MJPEG: the same pictures from a small camera server, shown in an <img>.",
        _page_figures(page_ages, rate, interval_ms) + _peer_figures(page_ages, mjpeg_ages, peer_ages),
    )


def _page_figures(ages: list[float], drawn_hz: float, interval_ms: float) -> tuple[Figure, ...]:
    middle, late = median(ages), percentile(ages, 95)
    return (
        Figure("page: median age", middle / interval_ms, "intervals", at_most(0.5), f"{middle:.1f} ms"),
        Figure("page: 95 % of ages", late / interval_ms, "intervals", at_most(0.8), f"{late:.1f} ms"),
        Figure("page: new pictures drawn", drawn_hz, "Hz"),
    )


def _peer_figures(page: list[float], mjpeg: list[float], peer: list[float]) -> tuple[Figure, ...]:
    ratio = median(page) / median(peer)
    return (
        Figure("page over plain MJPEG, median ages", ratio, "", at_most(0.4), f"{median(peer):.1f} ms"),
        Figure(
            "our /stream.mjpg over plain MJPEG, median ages",
            median(mjpeg) / median(peer),
            "",
            None,
            f"{median(mjpeg):.1f} ms",
        ),
    )


async def _page(
    browser: "Browser", server: PatternServer, seconds: float, clock: Clock
) -> tuple[list[float], float]:
    """Return the ages [ms] on the operator page, and how many pictures a second it painted."""
    async with _observed(server, clock) as viewing, fresh_page(browser) as page:
        await page.goto(server.url)
        await page.wait_for_selector(f"{CANVAS}[data-frame-id]")
        await clock.sleep_until(clock.now_ns() + SECOND)
        painted = await watch_painting(page, seconds, clock)
    return painted_ages_ms(painted, viewing.captured_ns), len(painted) / seconds


async def _mjpeg(browser: "Browser", server: PatternServer, seconds: float, clock: Clock) -> list[float]:
    async with _observed(server, clock) as viewing, fresh_page(browser) as page:
        await page.goto(f"{server.url}snapshot.jpg")
        await page.evaluate(_SHOW_STREAM)
        drawing = await watch_drawing(page, "img", server.size, seconds, clock)
    return ages_ms(drawing, viewing.captured_ns)


@contextlib.asynccontextmanager
async def _observed(server: PatternServer, clock: Clock) -> AsyncIterator[Viewing]:
    # A Python viewer beside the browser learns from the headers when each frame was captured.
    viewing = Viewing()
    observer = asyncio.create_task(view(server.port, viewing, clock))
    try:
        yield viewing
    finally:
        await finish(observer)


async def _peer(
    browser: "Browser", size: ImageSize, rate_hz: float, seconds: float, seed: int, clock: Clock
) -> list[float]:
    arguments = (size.width, size.height, rate_hz, seed)
    async with started("tapreach.bench.mjpeg_peer", *arguments) as peer, fresh_page(browser) as page:
        url = f"http://localhost:{peer.port}"
        await page.goto(url)
        await page.evaluate(_SHOW_STREAM)
        drawing = await watch_drawing(page, "img", size, seconds, clock)
        captured_ns = await asyncio.to_thread(_captured, url)
    return ages_ms(drawing, captured_ns)


def _captured(url: str) -> dict[int, int]:
    with urlopen(f"{url}/captured.json", timeout=10) as answer:
        return dict(enumerate(json.load(answer)))
