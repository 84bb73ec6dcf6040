"""Does a tap name the picture that was painted? Thousands of them, against the bar code on the canvas."""

import random
from pathlib import Path
from typing import TYPE_CHECKING

from tapreach.bench.browser import chromium_page
from tapreach.bench.figure import Figure, exactly
from tapreach.bench.painted import CANVAS
from tapreach.bench.pattern import CODES
from tapreach.bench.report import Section
from tapreach.bench.served import PatternServer
from tapreach.robot.clock import MS, Clock

if TYPE_CHECKING:
    from playwright.async_api import Page

_PROBE = Path(__file__).with_name("tap_probe.js")
Pairs = list[tuple[int, int | None]]


async def measure_taps(
    server: PatternServer, synthetic: int, trusted: int, seed: int, clock: Clock
) -> Section:
    """Tap by events made in the page, and with the browser's own mouse."""
    async with chromium_page() as page:
        await page.add_init_script(path=_PROBE)
        await page.goto(server.url)
        await page.wait_for_selector(f"{CANVAS}[data-frame-id]")
        await page.evaluate(
            "([s, a]) => tapreachTaps.watch(s, a)", [CANVAS, server.size.width / server.size.height]
        )
        by_event: Pairs = await page.evaluate("([n, s]) => tapreachTaps.tapMany(n, s)", [synthetic, seed])
        await page.evaluate("tapreachTaps.pairs = []")
        by_mouse = await _tap_with_mouse(page, trusted, random.Random(seed), clock)
    return Section(
        "Taps name the painted picture",
        "Each tap's frame id against the bar code on the canvas when the finger came down; a miss is a tap "
        "that names another picture or was not sent.",
        _figures("events made in the page", synthetic, by_event)
        + _figures("the browser's mouse", trusted, by_mouse),
    )


async def _tap_with_mouse(page: "Page", count: int, chance: random.Random, clock: Clock) -> Pairs:
    box = await page.locator(CANVAS).bounding_box()
    assert box is not None
    for _ in range(count):
        x = box["x"] + box["width"] * chance.uniform(0.3, 0.7)
        y = box["y"] + box["height"] * chance.uniform(0.3, 0.7)
        await page.mouse.click(x, y)
        await clock.sleep_until(clock.now_ns() + chance.randint(0, 60) * MS)
    pairs: Pairs = await page.evaluate("tapreachTaps.pairs")
    return pairs


def _figures(how: str, count: int, pairs: Pairs) -> tuple[Figure, ...]:
    right = sum(code is not None and frame_id % CODES == code for frame_id, code in pairs)
    pictures = len({frame_id for frame_id, _ in pairs})
    note = f"{count} taps on {pictures} pictures"
    return (Figure(f"misses, by {how}", count - right, "", exactly(0), note),)
