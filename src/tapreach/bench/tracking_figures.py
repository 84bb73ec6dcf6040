"""The tracking bench's figures: what is wanted of the tracker, and the table beside OpenCV."""

from collections.abc import Mapping, Sequence

from tapreach.bench.figure import Figure, Limit, at_least, at_most, plain
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.bench.tracking_motions import Motion
from tapreach.bench.tracking_outcomes import Outcome, outcome_of
from tapreach.bench.tracking_run import Run

OURS = "tapreach"
Runs = Mapping[Motion, Sequence[Run]]
_COLUMNS = (
    "motion", "tracker", "points", "drift", "95 %", "in first", "95 %", "error/sigma", "jumped %",
    "unsaid %", "lost %", "again %", "ms", "95 %",
)  # fmt: skip


def wanted_section(runs: Runs, method: str) -> Section:
    """Return the figures that are held to limits, over all motions."""
    every = outcome_of([run for of_motion in runs.values() for run in of_motion])
    moving = outcome_of(
        [run for motion, some in runs.items() if motion is not Motion.APPROACH for run in some]
    )
    near = outcome_of(list(runs.get(Motion.APPROACH, ())))
    figures = (
        Figure("points", every.points),
        _figure("drift: median", moving.drift_median, "px", at_most(0.5), "without the approach"),
        _figure("drift: 95 %", moving.drift_p95, "px", None, "without the approach"),
        _figure("drift of the approach: median", near.in_first_median, "px", at_most(1.5), "as tapped"),
        _figure("drift of the approach: 95 %", near.in_first_p95, "px", None, "as tapped"),
        _figure("error over sigma, at least", every.normalised, "", at_least(0.8), "root mean square"),
        _figure("error over sigma, at most", every.normalised, "", at_most(1.5)),
        _figure("points that jumped", every.jumped, "%", at_most(0.5), "more than 8 px, not said lost"),
        _figure("points that jumped by 4 sigma", every.jumped_unsaid, "%", None, "nothing warned"),
        _figure("pictures falsely lost", every.lost, "%", at_most(3.0), "of those that show the point"),
        _figure("pictures unsure", every.unsure, "%"),
        _figure("found again", every.found_again, "%", None, "by the third picture or later"),
        _figure("time of a picture: median", every.took_median_ms, "ms"),
        _figure("time of a picture: 95 %", every.took_p95_ms, "ms"),
        _figure("time of a picture: longest", every.took_most_ms, "ms", at_most(10.0), "processor time"),
    )
    return Section("Tapped points followed", method, figures)


def beside_section(by_tracker: Mapping[str, Runs]) -> Section:
    """Return the table of every tracker at every motion, and OpenCV's figures together."""
    rows = [
        _row(motion, tracker, outcome_of(runs[motion]))
        for motion in Motion
        for tracker, runs in by_tracker.items()
        if runs.get(motion)
    ]
    figures = []
    for tracker, runs in by_tracker.items():
        every = outcome_of([run for of_motion in runs.values() for run in of_motion])
        figures += [
            _figure(f"{tracker}: points that jumped", every.jumped, "%"),
            _figure(f"{tracker}: pictures falsely lost", every.lost, "%"),
        ]
    return Section(
        "Beside OpenCV",
        "The same pictures. KLT: calcOpticalFlowPyrLK, window 21, 3 levels, forward-backward check at 1 px; "
        "once from picture to picture, once from the tapped picture started at the last place.",
        tuple(figures),
        Grid(_COLUMNS, tuple(rows)),
    )


def _figure(
    name: str, value: float | None, unit: str = "", limit: Limit | None = None, note: str = ""
) -> Figure:
    return Figure(
        name, value, unit, limit, note if value is not None else "there was nothing to measure it on"
    )


def _row(motion: Motion, tracker: str, outcome: Outcome) -> tuple[str, ...]:
    values = (
        outcome.drift_median, outcome.drift_p95, outcome.in_first_median, outcome.in_first_p95,
        outcome.normalised, outcome.jumped, outcome.jumped_unsaid, outcome.lost, outcome.found_again,
        outcome.took_median_ms, outcome.took_p95_ms,
    )  # fmt: skip
    shown = ("—" if value is None else plain(value) for value in values)
    return (motion.value, tracker, str(outcome.points), *shown)
