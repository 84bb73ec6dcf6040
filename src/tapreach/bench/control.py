"""The control bench: how fast a command arrives, how fast the wheels stop, and what is left behind."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from tapreach.bench.control_hold import measure_hold
from tapreach.bench.control_latency import measure_latency
from tapreach.bench.control_leftover import ENDS, measure_leftovers
from tapreach.bench.control_stop import measure_stops
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.bench.served import PatternServer, pattern_server
from tapreach.bench.video import RATE_HZ, VGA
from tapreach.robot.clock import Clock


@dataclass(frozen=True)
class ControlPlan:
    """How long and how often."""

    seconds: float = 60.0
    """Of driving for the round trip, half of it while estimating."""
    stops: int = 20
    """In each of the ways to stop."""
    hold_seconds: float = 610.0
    freezes: int = 10
    ends: tuple[str, ...] = tuple(ENDS)
    """Ways in which a run is ended."""
    is_smoke: bool = False
    seed: int = 1


def smoke_plan() -> ControlPlan:
    """A plan that only shows that everything works."""
    return ControlPlan(seconds=2.0, stops=1, hold_seconds=2.0, freezes=1, ends=("SIGKILL",), is_smoke=True)


async def run_control(plan: ControlPlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run the whole bench."""

    def served(measure: Callable[[PatternServer], Awaitable[Section]]) -> Callable[[], Awaitable[Section]]:
        async def run() -> Section:
            async with pattern_server(VGA, RATE_HZ, plan.seed) as server:
                return await measure(server)

        return run

    measurements = (
        Measurement("Round trip", served(lambda s: measure_latency(s, plan.seconds, plan.seed, clock))),
        Measurement("Stops", served(lambda s: measure_stops(s, plan.stops, plan.seed, clock))),
        Measurement("Page", served(lambda s: measure_hold(s, plan.hold_seconds, plan.freezes, clock))),
        Measurement("Leftovers", lambda: measure_leftovers(plan.ends, clock)),
    )
    return await run_series("control", "Control", plan.is_smoke, measurements, on_section, clock)
