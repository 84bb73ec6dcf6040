"""The simulated robot as `tapreach run` serves it: picture rate, age on the page, real time, processor."""

import asyncio

import numpy as np

from tapreach.bench.browser import chromium_page
from tapreach.bench.control_client import ControlClient, operator
from tapreach.bench.ending import finish
from tapreach.bench.figure import Figure, at_least, at_most
from tapreach.bench.painted import CANVAS, painted_ages_ms, watch_painting
from tapreach.bench.proc import ProcessId, cpu_seconds
from tapreach.bench.process_role import role_of
from tapreach.bench.report import Section
from tapreach.bench.sample import median, percentile, slope
from tapreach.bench.simulated import SimulatedRun, simulated_run
from tapreach.bench.video_client import Viewing, view
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.messages import Twist

START_LIMIT_S = 5.0
WANTED_HZ = 30.0
SPIN = Twist(0.0, 0.6)
RAMP_NS = SECOND


async def measure_simulator(starts: int, seconds: float, clock: Clock) -> Section:
    """Start it `starts` times, since only the second start is warm; watch the last in Chromium, turning."""
    for _ in range(starts - 1):
        async with simulated_run(clock) as run:
            await run.first_picture(clock)
    async with simulated_run(clock) as run:
        start_s = (await run.first_picture(clock) - run.begun_ns) / SECOND
        viewing = Viewing()
        observer = asyncio.create_task(view(run.port, viewing, clock))
        try:
            figures = await _watch(run, viewing, seconds, clock)
        finally:
            await finish(observer)
    return Section(
        "The simulated robot",
        "`tapreach run` with its default scene, turning on the spot, watched by Chromium and a Python viewer "
        "on the same cores. Age: from the middle of the exposure. Turn rate: the wheels keep the rate that "
        "was sent in the simulation's time, so the ratio tells how fast that time passes.",
        (Figure("process start to first picture", start_s, "s", at_most(START_LIMIT_S)), *figures),
    )


async def _watch(run: SimulatedRun, viewing: Viewing, seconds: float, clock: Clock) -> tuple[Figure, ...]:
    async with chromium_page() as page, operator(run.port, clock) as client:
        await page.goto(run.url)
        await page.wait_for_selector(f"{CANVAS}[data-frame-id]")
        members = run.family
        cpu_before, begin_ns = _cpu(members), clock.now_ns()
        spinning = asyncio.create_task(_turn_rate_ratio(client, viewing, seconds, clock))
        painted = await watch_painting(page, seconds, clock)
        ratio = await spinning
        duration = (clock.now_ns() - begin_ns) / SECOND
        shares = {who: used - cpu_before[who] for who, used in _cpu(members).items()}
    seen = viewing.since(begin_ns)
    ages = painted_ages_ms(painted, viewing.captured_ns)
    intervals = np.diff([arrival.captured_ns for arrival in seen.arrivals]) / MS
    return (
        Figure("pictures at a Python viewer", seen.rate_hz, "Hz", at_least(0.95 * WANTED_HZ)),
        Figure("between two exposures: 95 %", percentile(intervals.tolist(), 95), "ms"),
        Figure("pictures painted in Chromium", len(painted) / seconds, "Hz"),
        Figure("age at a Python viewer: median", median(seen.ages_ms), "ms"),
        Figure("age as painted in Chromium: median", median(ages), "ms"),
        Figure("age as painted in Chromium: 95 %", percentile(ages, 95), "ms"),
        Figure("turn rate by odometry over the rate sent", ratio, "", at_least(0.95)),
        *(Figure(f"processor: {who}", 100 * share / duration, "%") for who, share in shares.items()),
    )


def _cpu(members: list[ProcessId]) -> dict[str, float]:
    """Return seconds used so far by role; processes that have ended are left out."""
    used: dict[str, float] = {}
    for member in members:
        role = role_of(member)
        try:
            used[role] = used.get(role, 0.0) + cpu_seconds(member.pid)
        except OSError:
            continue
    return used


async def _turn_rate_ratio(client: ControlClient, viewing: Viewing, seconds: float, clock: Clock) -> float:
    begin_ns = clock.now_ns()
    readings: list[tuple[float, float]] = []
    while clock.now_ns() < begin_ns + round(seconds * SECOND):
        answer = await client.drive(SPIN, viewing.arrivals[-1].frame_id)
        state = client.newest.get("state")
        if state and state["odometry"] and answer.sent_ns > begin_ns + RAMP_NS:
            readings.append((state["server_ns"] / SECOND, np.radians(state["odometry"]["heading_deg"])))
        await clock.sleep_until(answer.sent_ns + 50 * MS)
    await client.ask("stop", reason="release")
    headings = np.unwrap([heading for _, heading in readings]).tolist()
    return slope([when for when, _ in readings], headings) / SPIN.angular
