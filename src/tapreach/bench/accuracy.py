"""The accuracy bench: the estimator in simulation against its bound, its own regions and its peers."""

from collections.abc import Awaitable, Callable

from tapreach.bench.accuracy_beside import measure_beside
from tapreach.bench.accuracy_cells import CellResult, cells_section, intervals_section, run_cells
from tapreach.bench.accuracy_motions import measure_motions
from tapreach.bench.accuracy_moves import measure_moves
from tapreach.bench.accuracy_odd_taps import measure_odd_taps
from tapreach.bench.accuracy_plan import AccuracyPlan, Chapter
from tapreach.bench.accuracy_plot import draw_settings, require_matplotlib
from tapreach.bench.accuracy_slips import measure_slips
from tapreach.bench.report import Report, Section
from tapreach.bench.series import Measurement, run_series
from tapreach.robot.clock import Clock


async def run_accuracy(plan: AccuracyPlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run the whole bench or one chapter of it; the times first, while nothing else of it runs.

    Raises ConfigError at once where a plot is wanted and cannot be drawn.
    """
    if plan.plot is not None:
        require_matplotlib()
    chapters = _chapters(plan, clock)
    chosen = chapters if plan.chapter is None else {plan.chapter: chapters[plan.chapter]}
    alone = "" if plan.chapter is None else f" --part {plan.chapter}"
    return await run_series(
        f"accuracy{alone}",
        "Accuracy" if plan.chapter is None else f"Accuracy: {plan.chapter}",
        plan.is_smoke,
        [each for measurements in chosen.values() for each in measurements],
        on_section,
        clock,
        seed=plan.seed,
    )


def _chapters(plan: AccuracyPlan, clock: Clock) -> dict[Chapter, tuple[Measurement, ...]]:
    results: list[CellResult] = []

    def every_setting() -> Section:
        results.extend(run_cells(plan))
        if plan.plot is not None:
            draw_settings(results, plan.plot)
        return cells_section(results, plan)

    return {
        Chapter.BESIDE: (Measurement("Beside others", _later(lambda: measure_beside(plan, clock))),),
        Chapter.SETTINGS: (
            Measurement("Every setting", _later(every_setting)),
            Measurement("95 % range interval", _later(lambda: intervals_section(results, plan.trials))),
        ),
        Chapter.MOTIONS: (Measurement("Random motions", _later(lambda: measure_motions(plan))),),
        Chapter.MOVES: (Measurement("The chosen move", _later(lambda: measure_moves(plan))),),
        Chapter.SLIPS: (Measurement("One slipped tap among five", _later(lambda: measure_slips(plan))),),
        Chapter.ODD_TAPS: (Measurement("Odd taps", _later(lambda: measure_odd_taps(plan))),),
    }


def _later(measure: Callable[[], Section]) -> Callable[[], Awaitable[Section]]:
    async def run() -> Section:
        return measure()

    return run
