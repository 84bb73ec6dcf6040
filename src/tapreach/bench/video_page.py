"""Video in Chromium: the operator page against MJPEG in an <img>, both read by their bar codes."""

import asyncio
import json
from typing import TYPE_CHECKING
from urllib.request import urlopen

from tapreach.bench.browser import chromium, fresh_page
from tapreach.bench.child import started
from tapreach.bench.drawn import Drawing, ages_ms, watch_drawing
from tapreach.bench.ending import finish
from tapreach.bench.figure import Figure, at_most
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile
from tapreach.bench.served import PatternServer
from tapreach.bench.video_client import Viewing, view
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import Clock

if TYPE_CHECKING:
    from playwright.async_api import Browser, Page

CANVAS = "canvas#picture"
_SHOW_STREAM = "document.body.innerHTML = '<img src=/stream.mjpg>'"
Ages = tuple[list[float], Drawing]


async def measure_page(
    server: PatternServer, rate_hz: float, seconds: float, seed: int, clock: Clock
) -> Section:
    """Measure the operator page, our own MJPEG and the plain MJPEG peer, each alone in the browser."""
    async with chromium() as browser:

        async def watch(path: str, script: str, selector: str) -> Ages:
            return await _with_observer(browser, server, path, script, selector, seconds, clock)

        page_ages, drawing = await watch("/", "", CANVAS)
        mjpeg_ages, _ = await watch("/snapshot.jpg", _SHOW_STREAM, "img")
        peer_ages, _ = await _peer(browser, server.size, rate_hz, seconds, seed, clock)
    interval_ms = 1000 / rate_hz
    return Section(
        f"Chromium, {server.size.width} x {server.size.height}",
        "Age: from capture to the animation frame in which the bar code is on the canvas. Plain MJPEG: the "
        "same pictures from a small camera server, shown in an <img>. The clocks of page and server agree "
        f"within {drawing.clock_uncertainty_ms:.1f} ms.",
        _page_figures(page_ages, drawing, interval_ms) + _peer_figures(page_ages, mjpeg_ages, peer_ages),
    )


def _page_figures(ages: list[float], drawing: Drawing, interval_ms: float) -> tuple[Figure, ...]:
    middle, late = median(ages), percentile(ages, 95)
    return (
        Figure("page: median age", middle / interval_ms, "intervals", at_most(0.5), f"{middle:.1f} ms"),
        Figure("page: 95 % of ages", late / interval_ms, "intervals", at_most(0.8), f"{late:.1f} ms"),
        Figure("page: new pictures drawn", drawing.rate_hz, "Hz"),
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


async def _with_observer(
    browser: "Browser",
    server: PatternServer,
    path: str,
    script: str,
    selector: str,
    seconds: float,
    clock: Clock,
) -> Ages:
    # A Python viewer beside the browser learns from the headers when each frame was captured.
    viewing = Viewing()
    observer = asyncio.create_task(view(server.port, viewing, clock))
    try:
        async with fresh_page(browser) as page:
            await page.goto(server.url.rstrip("/") + path)
            drawing = await _watch(page, script, selector, server.size, seconds, clock)
    finally:
        await finish(observer)
    captured_ns = {arrival.frame_id: arrival.captured_ns for arrival in viewing.arrivals}
    return ages_ms(drawing, captured_ns), drawing


async def _watch(
    page: "Page", script: str, selector: str, size: ImageSize, seconds: float, clock: Clock
) -> Drawing:
    if script:
        await page.evaluate(script)
    return await watch_drawing(page, selector, size, seconds, clock)


async def _peer(
    browser: "Browser", size: ImageSize, rate_hz: float, seconds: float, seed: int, clock: Clock
) -> Ages:
    arguments = (size.width, size.height, rate_hz, seed)
    async with started("tapreach.bench.mjpeg_peer", *arguments) as peer, fresh_page(browser) as page:
        url = f"http://localhost:{peer.port}"
        await page.goto(url)
        drawing = await _watch(page, _SHOW_STREAM, "img", size, seconds, clock)
        captured_ns = await asyncio.to_thread(_captured, url)
    return ages_ms(drawing, captured_ns), drawing


def _captured(url: str) -> dict[int, int]:
    with urlopen(f"{url}/captured.json", timeout=10) as answer:
        return dict(enumerate(json.load(answer)))
