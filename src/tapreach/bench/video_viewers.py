"""Video at Python viewers: age on arrival with 1, 4 and 16 of them, and what a frame costs the server."""

from collections.abc import Awaitable

from tapreach.bench.figure import Figure, at_most
from tapreach.bench.proc import cpu_seconds
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile
from tapreach.bench.served import PatternServer
from tapreach.bench.video_client import Viewing, view_many
from tapreach.robot.clock import SECOND, Clock

AGE_LIMITS = {1: 0.1, 4: 0.1, 16: 0.15}
"""Most median age by number of viewers, in frame intervals."""
CPU_LIMIT_MS = 0.15
"""Most server time per delivered frame with 16 viewers."""
SETTLE_NS = 2 * SECOND
"""Its own imports and its worker's start are no part of what a server uses."""


async def measure_viewers(server: PatternServer, rate_hz: float, seconds: float, clock: Clock) -> Section:
    """Measure each number of viewers after the other."""
    await clock.sleep_until(clock.now_ns() + SETTLE_NS)
    _, idle_share = await _while_measuring_cpu(server, view_many([], seconds, clock), clock)
    figures = [Figure("no viewer: server's share of a core", 100 * idle_share, "%")]
    for count, limit in AGE_LIMITS.items():
        watching = view_many([server.port] * count, seconds, clock, settle_seconds=0.5)
        viewings, share = await _while_measuring_cpu(server, watching, clock)
        figures += _figures(count, limit, viewings, rate_hz, share - idle_share)
    return Section(
        f"Python viewers, {server.size.width} x {server.size.height}",
        "Each viewer acknowledges every frame at once. Age: from capture to reception, in frame intervals. "
        "Server time per frame: above what the server uses without viewers.",
        tuple(figures),
    )


async def _while_measuring_cpu(
    server: PatternServer, watching: Awaitable[list[Viewing]], clock: Clock
) -> tuple[list[Viewing], float]:
    """Return what was seen, and the share of a core that the server used meanwhile."""
    cpu_before, begin_ns = cpu_seconds(server.child.pid), clock.now_ns()
    viewings = await watching
    cpu = cpu_seconds(server.child.pid) - cpu_before
    return viewings, cpu * SECOND / (clock.now_ns() - begin_ns)


def _figures(
    count: int, limit: float, viewings: list[Viewing], rate_hz: float, cpu_share: float
) -> list[Figure]:
    ages_ms = [age for viewing in viewings for age in viewing.ages_ms]
    interval_ms = 1000 / rate_hz
    who = f"{count} viewer{'s' if count > 1 else ''}"
    delivered_hz = sum(viewing.rate_hz for viewing in viewings)
    middle, late = median(ages_ms), percentile(ages_ms, 95)
    cpu_limit = at_most(CPU_LIMIT_MS) if count == 16 else None
    return [
        Figure(f"{who}: median age", middle / interval_ms, "intervals", at_most(limit), f"{middle:.2f} ms"),
        Figure(f"{who}: 95 % of ages", late / interval_ms, "intervals", None, f"{late:.2f} ms"),
        Figure(f"{who}: slowest viewer's rate", min(viewing.rate_hz for viewing in viewings), "Hz"),
        Figure(f"{who}: server time per delivered frame", 1000 * cpu_share / delivered_hz, "ms", cpu_limit),
    ]
