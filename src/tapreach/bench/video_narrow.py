"""Video over links that cannot carry it: a slow viewer among others, and a whole link of 6 Mbit/s."""

from tapreach.bench.figure import Figure, at_least, at_most
from tapreach.bench.narrow_link import narrow_link
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile, slope
from tapreach.bench.served import PatternServer
from tapreach.bench.video_client import Viewing, view_many
from tapreach.robot.clock import SECOND, Clock

SLOW_SHARE = 0.3
"""What the slow viewer's link carries of the stream."""
NARROW_BITS_PER_SECOND = 6_000_000
OTHERS = 3


async def measure_slow_viewer(
    server: PatternServer, rate_hz: float, seconds: float, adapt_seconds: float, clock: Clock
) -> Section:
    """Compare viewers with and without a slow one beside them, twice each in turn, and watch the slow one.

    The quality has `adapt_seconds` to follow the link before each measurement.
    """
    alone: list[float] = []
    beside: list[float] = []
    slow = Viewing()
    stream_bytes = await _stream_bytes_per_second(server, clock)
    serial_ms = 1000 / (SLOW_SHARE * rate_hz)
    for _ in range(2):
        viewings = await view_many([server.port] * OTHERS, seconds / 2, clock)
        alone += [age for viewing in viewings for age in viewing.ages_ms]
        async with narrow_link(server.port, SLOW_SHARE * stream_bytes, clock) as slow_port:
            ports = [server.port] * OTHERS + [slow_port]
            *viewings, slow = await view_many(ports, seconds, clock, adapt_seconds)
        beside += [age for viewing in viewings for age in viewing.ages_ms]
    return Section(
        f"One slow viewer among {OTHERS + 1}",
        f"One viewer's link carries {SLOW_SHARE:.0%} of the stream's {stream_bytes / 1000:.0f} kB/s. Serial "
        "time: what an unreduced frame needs to pass through that link.",
        _slow_figures(slow, serial_ms) + _other_figures(alone, beside),
    )


async def _stream_bytes_per_second(server: PatternServer, clock: Clock) -> float:
    (viewing,) = await view_many([server.port], 1.0, clock, settle_seconds=0.5)
    return viewing.rate_hz * median([arrival.size_bytes for arrival in viewing.arrivals])


def _slow_figures(slow: Viewing, serial_ms: float) -> tuple[Figure, ...]:
    growth = slope([arrival.received_ns / SECOND for arrival in slow.arrivals], slow.ages_ms)
    sizes = [arrival.size_bytes for arrival in slow.arrivals]
    age_ms = median(slow.ages_ms)
    return (
        Figure(
            "slow viewer: median age over serial time",
            age_ms / serial_ms,
            "",
            at_most(1.5),
            f"{age_ms:.0f} ms over {serial_ms:.0f} ms",
        ),
        Figure("slow viewer: growth of age (either way)", abs(growth), "ms/s", at_most(5)),
        Figure("slow viewer: rate", slow.rate_hz, "Hz"),
        Figure("slow viewer: median frame", median(sizes) / 1000, "kB", None, _widths(slow)),
    )


def _other_figures(alone: list[float], beside: list[float]) -> tuple[Figure, ...]:
    without_ms, with_ms = percentile(alone, 95), percentile(beside, 95)
    return (
        Figure(
            "others: 95 % of ages, with over without the slow one",
            with_ms / without_ms,
            "",
            at_most(1.2),
            f"{with_ms:.2f} over {without_ms:.2f} ms",
        ),
    )


async def measure_narrow_link(
    server: PatternServer, seconds: float, adapt_seconds: float, clock: Clock
) -> Section:
    """Watch through a link of 6 Mbit/s, which carries a good half of the stream."""
    async with narrow_link(server.port, NARROW_BITS_PER_SECOND / 8, clock) as port:
        (viewing,) = await view_many([port], seconds, clock, adapt_seconds)
    sizes = [arrival.size_bytes for arrival in viewing.arrivals]
    return Section(
        "A link of 6 Mbit/s",
        f"One viewer; measured from {adapt_seconds:.0f} s on, when the quality has followed the link.",
        (
            Figure("rate", viewing.rate_hz, "Hz", at_least(25)),
            Figure("median age", median(viewing.ages_ms), "ms", at_most(60)),
            Figure("95 % of ages", percentile(viewing.ages_ms, 95), "ms"),
            Figure("median frame", median(sizes) / 1000, "kB", None, _widths(viewing)),
        ),
    )


def _widths(viewing: Viewing) -> str:
    widths = sorted({arrival.width for arrival in viewing.arrivals})
    return "width " + ", ".join(map(str, widths)) + " px"
