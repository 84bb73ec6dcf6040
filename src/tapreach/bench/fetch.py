"""The bench of fetching: one tap, and the thing is in the claw or it was said why not, against the truth."""

from collections.abc import Awaitable, Callable

from tapreach.bench.contact_sheet import write_sheet
from tapreach.bench.fetch_figures import beside_section, chapter_section, reasons_section
from tapreach.bench.fetch_outcome import FetchOutcome
from tapreach.bench.fetch_plan import Chapter, FetchBenchPlan
from tapreach.bench.fetch_runs import run_chapter
from tapreach.bench.many_runs import Budget
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.robot.clock import Clock


async def run_fetch_bench(
    plan: FetchBenchPlan, on_section: Callable[[Section], None], clock: Clock
) -> Report:
    """Run the chapters of the plan, then tell of them."""
    budget = Budget.of(plan.jobs, plan.minutes, clock)
    measurements = [each for chapter in plan.chapters for each in _measurements(plan, chapter, budget, clock)]
    alone = "" if plan.chapter is None else f" --part {plan.chapter}"
    title = "Fetching" if plan.chapter is None else f"Fetching: {plan.chapter}"
    report = await run_series(
        f"fetch{alone}", title, plan.is_smoke, measurements, on_section, clock, seed=plan.seed
    )
    if plan.failures is not None and plan.folder is not None:
        write_sheet(plan.folder, plan.failures)
    return report


def _measurements(plan: FetchBenchPlan, chapter: Chapter, budget: Budget, clock: Clock) -> list[Measurement]:
    outcomes: list[FetchOutcome] = []

    async def first() -> Section:
        outcomes.extend(await run_chapter(plan, chapter, budget, clock))
        return chapter_section(chapter, whole())

    def whole() -> list[FetchOutcome]:
        return [outcome for outcome in outcomes if outcome.arm == plan.arms[0]]

    measurements = [
        Measurement(chapter.value, first),
        Measurement(f"{chapter}: what went wrong", _later(lambda: reasons_section(chapter, whole()))),
    ]
    if chapter is Chapter.DEFAULT and len(plan.arms) > 1:
        measurements.append(Measurement("Side by side", _later(lambda: beside_section(outcomes))))
    return measurements


def _later(measure: Callable[[], Section]) -> Callable[[], Awaitable[Section]]:
    async def run() -> Section:
        return measure()

    return run
