"""The video bench: how old pictures are at one and many viewers, over thin links, and on the page."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.bench.served import PatternServer, pattern_server
from tapreach.bench.video_narrow import measure_narrow_link, measure_slow_viewer
from tapreach.bench.video_page import measure_page
from tapreach.bench.video_simulator import measure_simulator
from tapreach.bench.video_taps import measure_taps
from tapreach.bench.video_viewers import measure_viewers
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import Clock

RATE_HZ = 30.0
VGA = ImageSize(640, 480)
HD = ImageSize(1280, 720)


@dataclass(frozen=True)
class VideoPlan:
    """How long and how often."""

    seconds: float = 20.0
    """For each measurement of an age."""
    adapt_seconds: float = 3.0
    """For the quality to follow a thin link before it is measured."""
    sizes: tuple[ImageSize, ...] = (VGA, HD)
    """Of the pictures in Chromium."""
    simulator_starts: int = 2
    """The last is measured; from the second on they are warm."""
    taps: int = 10_000
    mouse_taps: int = 300
    is_smoke: bool = False
    seed: int = 1


def smoke_plan() -> VideoPlan:
    """A plan that only shows that everything works."""
    return VideoPlan(
        seconds=1.0,
        adapt_seconds=0.3,
        sizes=(VGA,),
        simulator_starts=1,
        taps=50,
        mouse_taps=5,
        is_smoke=True,
    )


async def run_video(plan: VideoPlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run the whole bench."""

    def served(
        size: ImageSize, measure: Callable[[PatternServer], Awaitable[Section]]
    ) -> Callable[[], Awaitable[Section]]:
        async def run() -> Section:
            async with pattern_server(size, RATE_HZ, plan.seed) as server:
                return await measure(server)

        return run

    seconds, adapt, seed = plan.seconds, plan.adapt_seconds, plan.seed

    async def in_chromium(server: PatternServer) -> Section:
        return await measure_page(server, RATE_HZ, seconds, seed, clock)

    measurements = (
        Measurement("Python viewers", served(VGA, lambda s: measure_viewers(s, RATE_HZ, seconds, clock))),
        Measurement(
            "Slow viewer", served(VGA, lambda s: measure_slow_viewer(s, RATE_HZ, seconds, adapt, clock))
        ),
        Measurement("6 Mbit/s", served(VGA, lambda s: measure_narrow_link(s, seconds, adapt, clock))),
        *(Measurement(f"Chromium, {size.width} px", served(size, in_chromium)) for size in plan.sizes),
        Measurement("Taps", served(VGA, lambda s: measure_taps(s, plan.taps, plan.mouse_taps, seed, clock))),
        Measurement("Simulator", lambda: measure_simulator(plan.simulator_starts, max(seconds, 3.0), clock)),
    )
    return await run_series("video", "Video", plan.is_smoke, measurements, on_section, clock)
