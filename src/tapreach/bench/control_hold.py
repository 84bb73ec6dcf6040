"""The operator page in Chromium: a key held for minutes must never stop the robot; a frozen tab must."""

import asyncio
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tapreach.bench.browser import align_clock, chromium_page
from tapreach.bench.control_stop import SILENCE_MS
from tapreach.bench.figure import Figure, at_least, at_most, exactly
from tapreach.bench.painted import CANVAS
from tapreach.bench.pattern_robot import SentTwist
from tapreach.bench.report import Section
from tapreach.bench.sample import median
from tapreach.bench.served import PatternServer, Wheels
from tapreach.robot.clock import MS, SECOND, Clock

if TYPE_CHECKING:
    from playwright.async_api import Page

KEY = "ArrowUp"
SETTLE_NS = SECOND
_FREEZE = """() => {
  const begun = performance.now();
  while (performance.now() < begun + 1000);
  return begun;
}"""


async def measure_hold(server: PatternServer, seconds: float, freezes: int, clock: Clock) -> Section:
    """Hold the key for `seconds` and count stops; then freeze the tab's script `freezes` times."""
    async with chromium_page() as page:
        await page.goto(server.url)
        await page.wait_for_selector(f"{CANVAS}[data-frame-id]")
        await wait_for_lease(page)
        hold = await _hold(page, server.wheels, seconds, clock)
        frozen_ms = [await _freeze(page, server.wheels, clock) for _ in range(freezes)]
    return Section(
        "The operator page, driving",
        "Headless Chromium holds the key; the page's worker sends the messages, beside the video. A false "
        "stop is a zero at the wheels while the key is held. Frozen tab: its script loops for a second while "
        "the sockets stay open; counted from the beginning of the loop.",
        (
            Figure("false stops", hold.stops, "", exactly(0)),
            Figure("key held", hold.seconds / 60, "min", at_least(10)),
            Figure("longest gap between two twists at the wheels", hold.longest_gap_ms, "ms"),
            Figure("frozen tab: median time to zero", median(frozen_ms), "ms", None, f"{freezes} times"),
            Figure("frozen tab: longest time to zero", max(frozen_ms), "ms", at_most(SILENCE_MS)),
        ),
    )


async def wait_for_lease(page: "Page") -> None:
    """Wait until the page drives: it takes a free robot by itself."""
    await page.wait_for_function("document.getElementById('lease-who').textContent === 'You'")


@dataclass(frozen=True)
class Hold:
    """What the wheels were told while the key was held."""

    seconds: float
    stops: int
    """Changes from moving to zero."""
    longest_gap_ms: float
    """Between two twists, zero or not."""


def hold_of(held: Sequence[SentTwist]) -> Hold:
    """Sum up the twists of a hold, at least two, in order."""
    pairs = list(itertools.pairwise(held))
    return Hold(
        seconds=(held[-1].sent_ns - held[0].sent_ns) / SECOND,
        stops=sum(after.twist.is_zero and not before.twist.is_zero for before, after in pairs),
        longest_gap_ms=max(after.sent_ns - before.sent_ns for before, after in pairs) / MS,
    )


async def _hold(page: "Page", wheels: Wheels, seconds: float, clock: Clock) -> Hold:
    pressed_ns = clock.now_ns()
    await page.keyboard.down(KEY)
    begin = await wheels.moving_after(pressed_ns)
    await clock.sleep_until(begin.sent_ns + round(seconds * SECOND))
    end_ns = clock.now_ns()
    await page.keyboard.up(KEY)
    return hold_of([sent for sent in wheels.sent if begin.sent_ns <= sent.sent_ns < end_ns])


async def _freeze(page: "Page", wheels: Wheels, clock: Clock) -> float:
    page_clock = await align_clock(page, clock)
    await page.keyboard.down(KEY)
    await wheels.moving_after(clock.now_ns())
    freezing = asyncio.create_task(page.evaluate(_FREEZE))
    begun_ns = page_clock.our_ns(await freezing)
    await page.keyboard.up(KEY)
    await clock.sleep_until(clock.now_ns() + SETTLE_NS)
    stop = await wheels.stop_after(begun_ns)
    return (stop.sent_ns - begun_ns) / MS
