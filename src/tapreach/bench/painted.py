"""When the operator page paints which frame, by the id on its canvas: for pictures without a bar code."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tapreach.bench.browser import PageClock, align_clock
from tapreach.robot.clock import MS, SECOND, Clock

if TYPE_CHECKING:
    from playwright.async_api import Page

CANVAS = "canvas#picture"
_WATCH = """(selector) => {
  const canvas = document.querySelector(selector);
  window.tapreachPainted = [];
  new MutationObserver(() => window.tapreachPainted.push([Number(canvas.dataset.frameId), performance.now()]))
    .observe(canvas, { attributes: true, attributeFilter: ["data-frame-id"] });
}"""


@dataclass(frozen=True, slots=True)
class PaintedFrame:
    """A frame that came onto the canvas."""

    frame_id: int
    painted_ns: int


async def watch_painting(page: "Page", seconds: float, clock: Clock) -> list[PaintedFrame]:
    """Return what the page paints in the coming seconds."""
    page_clock: PageClock = await align_clock(page, clock)
    await page.evaluate(_WATCH, CANVAS)
    await clock.sleep_until(clock.now_ns() + round(seconds * SECOND))
    rows: list[list[Any]] = await page.evaluate("tapreachPainted")
    return [PaintedFrame(int(frame_id), page_clock.our_ns(at_ms)) for frame_id, at_ms in rows]


def painted_ages_ms(painted: list[PaintedFrame], captured_ns: Mapping[int, int]) -> list[float]:
    """Return the age of each painted frame [ms]; frames whose capture time is not known are left out."""
    return [
        (frame.painted_ns - captured_ns[frame.frame_id]) / MS
        for frame in painted
        if frame.frame_id in captured_ns
    ]
