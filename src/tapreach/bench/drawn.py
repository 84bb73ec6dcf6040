"""From the bar codes that a page has drawn to the age of its pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tapreach.bench.browser import align_clock
from tapreach.bench.pattern import CODES
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS, SECOND, Clock

if TYPE_CHECKING:
    from playwright.async_api import Page


@dataclass(frozen=True, slots=True)
class DrawnFrame:
    """A bar code that appeared on the page."""

    code: int
    drawn_ns: int


@dataclass(frozen=True)
class Drawing:
    """What a page has drawn."""

    frames: tuple[DrawnFrame, ...]
    unreadable: int
    """Animation frames on which no code could be read."""
    clock_uncertainty_ms: float

    @property
    def rate_hz(self) -> float:
        """New pictures per second; 0 for fewer than two."""
        if len(self.frames) < 2:
            return 0.0
        return (len(self.frames) - 1) * SECOND / (self.frames[-1].drawn_ns - self.frames[0].drawn_ns)


async def watch_drawing(
    page: "Page", selector: str, size: ImageSize, seconds: float, clock: Clock
) -> Drawing:
    """Watch the <canvas> or <img> that `selector` names, after it has had a second to settle."""
    page_clock = await align_clock(page, clock)
    await page.wait_for_selector(selector)
    await clock.sleep_until(clock.now_ns() + SECOND)
    await page.evaluate("([s, a]) => tapreachProbe.start(s, a)", [selector, size.width / size.height])
    await clock.sleep_until(clock.now_ns() + round(seconds * SECOND))
    seen: dict[str, Any] = await page.evaluate("tapreachProbe.stop()")
    frames = tuple(DrawnFrame(code, page_clock.our_ns(at_ms)) for code, at_ms in seen["samples"])
    # The first code was on the page before we looked: when it appeared is not known.
    return Drawing(frames[1:], seen["unreadable"], page_clock.uncertainty_ms)


def ages_ms(drawing: Drawing, captured_ns: Mapping[int, int]) -> list[float]:
    """Return the age of each picture as drawn [ms], given the capture time of each frame id.

    A code stands for the newest frame of that code captured before it was drawn; pictures whose capture
    time is not known are left out.
    """
    by_code: dict[int, list[int]] = {}
    for frame_id, when_ns in captured_ns.items():
        by_code.setdefault(frame_id % CODES, []).append(when_ns)
    return [
        (frame.drawn_ns - newest_ns) / MS
        for frame in drawing.frames
        if (newest_ns := _newest_before(by_code.get(frame.code, ()), frame.drawn_ns)) is not None
    ]


def _newest_before(times_ns: Sequence[int], limit_ns: int) -> int | None:
    return max((when_ns for when_ns in times_ns if when_ns <= limit_ns), default=None)
