"""What `tapreach run` takes of a machine: memory and processor, with nobody watching and with one viewer."""

from collections.abc import Callable
from dataclasses import dataclass

from tapreach.bench.figure import Figure, at_most
from tapreach.bench.proc import ProcessId, cpu_seconds, memory_bytes
from tapreach.bench.process_role import role_of
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.bench.simulated import SimulatedRun, simulated_run
from tapreach.bench.video_client import view_many
from tapreach.robot.clock import SECOND, Clock

MOST_MB = 1000.0
"""Half of a Raspberry Pi with 2 GB, the smallest that is meant."""
SETTLE_S = 3.0


@dataclass(frozen=True)
class FootprintPlan:
    """Which robot, and how long for each part."""

    robot: str = "sim"
    seconds: float = 20.0
    is_smoke: bool = False


@dataclass(frozen=True)
class Footprint:
    """Of the processes of one role: memory [bytes] now, and processor time used so far [s]."""

    memory: int
    cpu: float


def footprints(members: list[ProcessId]) -> dict[str, Footprint]:
    """Return what each role takes; processes that have ended are left out."""
    found: dict[str, Footprint] = {}
    for member in members:
        try:
            now = Footprint(memory_bytes(member.pid), cpu_seconds(member.pid))
        except OSError:
            continue
        before = found.get(role_of(member), Footprint(0, 0.0))
        found[role_of(member)] = Footprint(before.memory + now.memory, before.cpu + now.cpu)
    return found


async def run_footprint(plan: FootprintPlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Measure a real `tapreach run`. Memory: each process's own, and its part of what it shares."""

    async def alone() -> Section:
        async with simulated_run(clock, plan.robot) as run:
            await run.first_picture(clock)
            await _wait(clock, min(SETTLE_S, plan.seconds))
            return await _measured("Nobody watches", run, plan, clock, 0)

    async def watched() -> Section:
        async with simulated_run(clock, plan.robot) as run:
            await run.first_picture(clock)
            return await _measured("One viewer watches", run, plan, clock, 1)

    parts = (Measurement("Nobody watches", alone), Measurement("One viewer watches", watched))
    return await run_series("run", "tapreach run", plan.is_smoke, parts, on_section, clock)


async def _measured(
    title: str, run: SimulatedRun, plan: FootprintPlan, clock: Clock, viewers: int
) -> Section:
    before, begin_ns = footprints(run.family), clock.now_ns()
    rate_hz = 0.0
    if viewers:
        viewing = (await view_many([run.port] * viewers, plan.seconds, clock))[0]
        rate_hz = viewing.rate_hz
    else:
        await _wait(clock, plan.seconds)
    after, duration_s = footprints(run.family), (clock.now_ns() - begin_ns) / SECOND
    return Section(
        title, f"`tapreach run --robot {plan.robot}`.", _figures(before, after, duration_s, rate_hz)
    )


def _figures(
    before: dict[str, Footprint], after: dict[str, Footprint], duration_s: float, rate_hz: float
) -> tuple[Figure, ...]:
    used = {role: now.cpu - before.get(role, Footprint(0, 0.0)).cpu for role, now in after.items()}
    total_mb = sum(now.memory for now in after.values()) / 1e6
    pictures = (Figure("pictures at the viewer", rate_hz, "Hz"),) if rate_hz else ()
    return (
        Figure("memory in all", total_mb, "MB", at_most(MOST_MB)),
        *(Figure(f"memory: {role}", now.memory / 1e6, "MB") for role, now in after.items()),
        *(Figure(f"processor: {role}", 100 * s / duration_s, "% of a core") for role, s in used.items()),
        *pictures,
    )


async def _wait(clock: Clock, seconds: float) -> None:
    await clock.sleep_until(clock.now_ns() + round(seconds * SECOND))
