"""Side by side in one run: error over bound, coverage and time of every way, on the same trials."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.bench.accuracy_cells import experiment_of
from tapreach.bench.accuracy_gtsam import gtsam_peers
from tapreach.bench.accuracy_outcomes import REGION_95
from tapreach.bench.accuracy_peers import Answer, Job, Peer, opencv, paper, tapreach, tapreach_trusting
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_trials import DEPTHS, VIEWS, Cell, draw_trials
from tapreach.bench.figure import Figure, Limit, at_most
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.geometry.finite import FloatArray
from tapreach.robot.clock import MS, Clock

OWN, TRUSTING, GTSAM = "tapreach", "tapreach, odometry taken as exact", "gtsam MAP"


@dataclass
class Tally:
    """errors of 1/Z over the bound, whether the region held where one was given, and times [ms]."""

    errors: list[float]
    held: list[bool]
    times_ms: list[float]
    trials: int = 0

    def __str__(self) -> str:
        if not self.errors:
            return "no answer"
        coverage = f"{100.0 * np.mean(self.held):.0f} %" if self.held else "—"
        lost = self.trials - len(self.errors)
        missing = f" ({lost} of {self.trials} without answer)" if lost else ""
        return f"{self.error_over_bound:.2f} / {coverage} / {self.median_ms:.3g} ms{missing}"

    @property
    def error_over_bound(self) -> float:
        """Root mean square."""
        return float(np.sqrt(np.mean(np.square(self.errors))))

    @property
    def median_ms(self) -> float:
        """Median time of one call [ms]."""
        return float(np.median(self.times_ms))


Table = dict[Cell, dict[str, Tally]]


def measure_beside(plan: AccuracyPlan, clock: Clock) -> Section:
    """Run every way on the trials of 12 settings, one call after the other in this process."""
    gtsam = gtsam_peers()
    peers: dict[str, Peer] = {
        OWN: tapreach,
        **gtsam,
        TRUSTING: tapreach_trusting,
        "OpenCV": opencv,
        "paper": paper,
    }
    cells = [Cell(depth, views, 1.0, 0.01) for views in VIEWS for depth in DEPTHS]
    table = {cell: _compare(number, cell, peers, plan, clock) for number, cell in enumerate(cells)}
    absent = "" if gtsam else " gtsam is not installed here, so it is not compared."
    return Section(
        "Beside others",
        "Error over bound / share of 95 % regions that hold the truth (— where none is given) / median time "
        f"of a call, in turns in one process, {plan.comparisons} trials each at 1 px and 1 %. OpenCV "
        "(triangulatePoints) and the paper's formula use the first and the last view, gtsam's triangulation "
        "(refined) all, with poses as the odometry says. gtsam MAP: its own factor graph of the same "
        "problem with the marginal covariance of the point. Making each one's own types is not "
        f"timed; building graph or model is. tapreach without advice.{absent}",
        tuple(_time_figures(table)),
        _grid(table, list(peers)),
    )


def _compare(
    number: int, cell: Cell, peers: dict[str, Peer], plan: AccuracyPlan, clock: Clock
) -> dict[str, Tally]:
    drawn = draw_trials(cell, plan.comparisons, generator(plan.seed, Part.PEERS, number))
    bound = float(experiment_of(cell, drawn).inverse_depth_sd)
    tallies = {name: Tally([], [], []) for name in peers}
    for peer in peers.values():
        _timed(
            peer(next(drawn.sightings()), cell), clock
        )  # the first call of all pays for caches and imports
    for observations, truth in zip(drawn.sightings(), drawn.targets, strict=True):
        for name, peer in peers.items():  # in turns: whatever else the machine does meets all alike
            answer, time_ms = _timed(peer(observations, cell), clock)
            _count(tallies[name], answer, time_ms, truth, bound)
    return tallies


def _timed(job: Job, clock: Clock) -> tuple[Answer | None, float]:
    begin_ns = clock.now_ns()
    try:
        result = job.run()
    except RuntimeError:  # gtsam's way to say that it found nothing
        return None, (clock.now_ns() - begin_ns) / MS
    time_ms = (clock.now_ns() - begin_ns) / MS
    return job.read(result), time_ms


def _count(tally: Tally, answer: Answer | None, time_ms: float, truth: FloatArray, bound: float) -> None:
    tally.trials += 1
    tally.times_ms.append(time_ms)
    if answer is None:
        return
    error = answer.target - truth
    tally.errors.append(float(error[2]) / bound)
    if answer.covariance is not None:
        tally.held.append(bool(error @ np.linalg.solve(answer.covariance, error) <= REGION_95))


def _grid(table: Table, names: Sequence[str]) -> Grid:
    rows = [(str(cell), *(str(tallies[name]) for name in names)) for cell, tallies in table.items()]
    return Grid(("setting", *names), tuple(rows))


def _time_figures(table: Table) -> list[Figure]:
    figures = []
    for cell, tallies in table.items():
        own = tallies[OWN].median_ms
        where = f"{cell.views} views, {cell.depth:g} m"
        limit: Limit | None = at_most(0.3) if cell.views == 2 else None
        figures.append(Figure(f"{where}: estimate with covariance", own, "ms", limit))
        if cell.views == max(VIEWS) and GTSAM in tallies:
            peer = tallies[GTSAM].median_ms
            figures.append(
                Figure(
                    f"{where}: time over gtsam's MAP", own / peer, "", at_most(1.0), f"gtsam {peer:.2f} ms"
                )
            )
    return figures
