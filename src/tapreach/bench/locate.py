"""The bench of locating: one tap, the robot moves by itself, and its answer is held against the truth."""

from collections.abc import Awaitable, Callable
from dataclasses import replace
from functools import partial

from tapreach.bench.accuracy_plot import require_matplotlib
from tapreach.bench.contact_sheet import write_sheet
from tapreach.bench.figure import Figure
from tapreach.bench.locate_figures import arm_section, beside_section
from tapreach.bench.locate_outcome import Outcome
from tapreach.bench.locate_plan import LocatePlan
from tapreach.bench.locate_plot import draw_taps
from tapreach.bench.locate_taps import run_taps
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.robot.clock import SECOND, Clock


async def run_locate(plan: LocatePlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run all taps, then tell of them. Raises ConfigError at once where a plot cannot be drawn."""
    if plan.plot is not None:
        require_matplotlib()
    outcomes: list[Outcome] = []

    async def first() -> Section:
        began_ns = clock.now_ns()
        outcomes.extend(await run_taps(plan, clock))
        _draw(plan, outcomes)
        seconds = (clock.now_ns() - began_ns) / SECOND
        return _with_speed(arm_section(plan.arms[0], outcomes, is_held=True), seconds, outcomes)

    measurements = [Measurement(str(plan.arms[0]), first)]
    measurements += [
        Measurement(str(arm), _later(partial(arm_section, arm, outcomes, is_held=False)))
        for arm in plan.arms[1:]
    ]
    measurements.append(Measurement("Side by side", _later(partial(beside_section, outcomes))))
    return await run_series(
        "locate", "Locating", plan.is_smoke, measurements, on_section, clock, seed=plan.seed
    )


def _later(measure: Callable[[], Section]) -> Callable[[], Awaitable[Section]]:
    async def run() -> Section:
        return measure()

    return run


def _draw(plan: LocatePlan, outcomes: list[Outcome]) -> None:
    if plan.plot is not None:
        draw_taps(outcomes, plan.plot)
    if plan.failures is not None and plan.folder is not None:
        write_sheet(plan.folder, plan.failures)


def _with_speed(section: Section, seconds: float, outcomes: list[Outcome]) -> Section:
    """Return the section with what the bench itself took, told of runs that were not continued."""
    simulated = sum(outcome.seconds for outcome in outcomes if not outcome.arm.endswith("formula"))
    took = sum(outcome.wall_seconds for outcome in outcomes if not outcome.arm.endswith("formula"))
    speed = Figure(
        "simulated over real time", simulated / took if took else None, note=f"{seconds:.0f} s in all"
    )
    return replace(section, figures=(*section.figures, speed))
