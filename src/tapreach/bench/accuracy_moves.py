"""The move that the product chooses, against the best that an exhaustive search finds and the paper's."""

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from tapreach.bench.accuracy_exhaustive import (
    MOST_ADVANCE,
    ON_THE_WAY,
    TWO_TAPS,
    Keeping,
    Sight,
    Views,
    best_move,
    is_kept,
    relative_sds,
)
from tapreach.bench.accuracy_judged import judged_cell
from tapreach.bench.accuracy_linear import linear
from tapreach.bench.accuracy_outcomes import estimate_all
from tapreach.bench.accuracy_plan import AccuracyPlan, Part, generator
from tapreach.bench.accuracy_robot import described_robot
from tapreach.bench.accuracy_scene import (
    CAMERA,
    LEVER,
    PITCH,
    project,
    target_at,
)
from tapreach.bench.accuracy_taps import normal
from tapreach.bench.accuracy_trials import DEPTHS, Cell, draw_trials
from tapreach.bench.figure import Figure, at_least, at_most
from tapreach.bench.grid import Grid
from tapreach.bench.report import Section
from tapreach.bench.spread import spread
from tapreach.estimation.next_view import relative_sds_after
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount
from tapreach.tasks.candidate_moves import MARGIN, NEAREST
from tapreach.tasks.move_choice import FREE_OF_CHARGE, choose_move

PAPERS = PlanarStep(math.radians(12.0), 0.2)
SIGMA_PX, ODOMETRY = 1.0, 0.01
SELDOM = 3
"""Trials of a move for one in a setting: 96 moves are tried, and little chance is left in them."""
PROTOCOLS = {"two taps": TWO_TAPS, "views on the way": ON_THE_WAY}


@dataclass(frozen=True)
class Move:
    """A move, the bound on sd(1/Z)·Z after it, and the root mean square error of 1/Z, times Z, in trials."""

    step: PlanarStep
    bound: float
    realised: float

    def __str__(self) -> str:
        turn, advance = math.degrees(self.step.turn), 100.0 * self.step.advance
        return f"{turn:.0f}°, {advance:.0f} cm: {100.0 * self.bound:.2f} / {100.0 * self.realised:.2f} %"


@dataclass(frozen=True)
class MoveResult:
    """One target, by number at its depth (0 in the middle of the picture), and the moves for it."""

    depth: float
    number: int
    protocol: str
    papers: Move
    chosen: Move
    best: Move

    @property
    def is_centred(self) -> bool:
        """True for a target in the middle of the picture, as the paper has it."""
        return self.number == 0


Task = tuple[float, int, str]


def measure_moves(plan: AccuracyPlan) -> Section:
    """Choose moves for targets at every depth, in the middle of the picture and elsewhere."""
    trials = max(2, plan.trials // SELDOM)
    tasks = [(depth, i, name) for depth in DEPTHS for i in range(plan.targets) for name in PROTOCOLS]
    results = spread(partial(_run, seed=plan.seed, trials=trials), tasks, plan.jobs)
    return Section(
        "The chosen move",
        f"At {SIGMA_PX:g} px and {100.0 * ODOMETRY:g} %, advance up to {100.0 * MOST_ADVANCE:.0f} cm, the "
        f"target {100.0 * MARGIN:.0f} % of the picture off its edges and {100.0 * NEAREST:.0f} cm away, of "
        "known distance, nothing charged for the way. Chosen: by the product. Best: of every turn and "
        "advance in a grid of 0.5° and 1 cm, made finer at the minimum, by the bench's own bound. Two taps: "
        "before and after the move. Views on the way, as the product has them: also after the turn and half "
        "way. The paper's move, 12° and 20 cm, has two taps throughout. Targets in the middle of the "
        f"picture, as the paper has them, and at {plan.targets - 1} other places at each depth that the "
        "paper's move keeps in it; high or low in it a target leaves it early, and no move gains as much. "
        f"The table has the bound on sd(1/Z)·Z / the root mean square error of {trials} estimates.",
        _figures(results),
        _grid(results),
    )


def _run(task: Task, seed: int, trials: int) -> MoveResult:
    depth, number, protocol = task
    views = PROTOCOLS[protocol]
    sight = Sight(_target(depth, number, seed), SIGMA_PX, ODOMETRY)
    random = generator(seed, Part.MOVES, 1000 + 100 * number + 10 * DEPTHS.index(depth) + len(views.shares))
    steps = (
        (PAPERS, TWO_TAPS),
        (chosen_move(sight, views), views),
        (best_move(sight, views, Keeping(MARGIN, NEAREST))[0], views),
    )
    return MoveResult(
        depth, number, protocol, *(_tried(sight, each, at, trials, random) for each, at in steps)
    )


def _target(depth: float, number: int, seed: int) -> FloatArray:
    if number == 0:
        return np.array([0.0, 0.0, 1.0 / depth])
    random = generator(seed, Part.MOVES, 10 * number + DEPTHS.index(depth))
    while True:
        target = np.array([*random.uniform([-0.45, -0.35], [0.45, 0.35]), 1.0 / depth])
        if is_kept(Sight(target, SIGMA_PX, ODOMETRY), PAPERS, Keeping(MARGIN, 0.1)):
            return target


def chosen_move(sight: Sight, views: Views) -> PlanarStep:
    """Return what the product chooses for a target of known distance, nothing charged for the way."""
    (pixel,) = project(np.array([[*sight.target[:2], 1.0]]))
    mount = camera_mount(LEVER, PITCH)
    seen = Observation(Pixel(*pixel.tolist()), sight.pixel_sigma, CAMERA, PlanarPose().to_rigid(), mount)
    noise = OdometryNoise.per_step(sight.odometry)

    def score(point: FloatArray, ways: FloatArray) -> FloatArray:
        stages = ways[:, -1:] if views is TWO_TAPS else ways
        return relative_sds_after([seen], noise, None, point, stages)

    (point,) = target_at(sight.target[None, :2], 1.0 / sight.target[2:])
    choice = choose_move(
        [], PlanarPose(), [point], MOST_ADVANCE, described_robot(), costs=FREE_OF_CHARGE, score=score
    )
    if choice is None:
        raise RuntimeError(f"no move was chosen for a target at {1.0 / sight.target[2]:g} m in the picture")
    return choice.step


def _tried(sight: Sight, step: PlanarStep, views: Views, trials: int, random: np.random.Generator) -> Move:
    turns, advances = np.array([step.turn]), np.array([step.advance])
    bound = float(relative_sds(sight, views, turns, advances)[0])
    cell = Cell(1.0 / float(sight.target[2]), len(views.shares) + 1, sight.pixel_sigma, sight.odometry)
    drive = views.drive(turns[0], advances[0])
    drawn = draw_trials(cell, trials, random, normal, drive=drive, bearing=sight.target[:2])
    sigmas = np.full(cell.views, sight.pixel_sigma)
    experiment = linear(drive, sight.target, sigmas, sight.odometry)
    figures = judged_cell(estimate_all(drawn, cell.noise), experiment.errors_of(drawn.chance), experiment)
    return Move(step, bound, bound * figures.error.value)


def _figures(results: list[MoveResult]) -> tuple[Figure, ...]:
    far = [result for result in results if result.depth >= 1.0]
    places = sorted({each.is_centred for each in far}, reverse=True)
    over_best = (_worst(name, [each for each in results if each.protocol == name]) for name in PROTOCOLS)
    gains = (_gain(name, is_centred, far) for name in PROTOCOLS for is_centred in places)
    return (*over_best, *gains)


def _worst(protocol: str, results: list[MoveResult]) -> Figure:
    worst = max(results, key=_over_best)
    note = f"{worst.depth:g} m; {len(results)} choices"
    return Figure(f"{protocol}: chosen over best, bound, worst", _over_best(worst), "", at_most(1.02), note)


def _gain(protocol: str, is_centred: bool, results: list[MoveResult]) -> Figure:
    chosen = [each for each in results if each.protocol == protocol and each.is_centred == is_centred]
    possible = min(each.papers.bound / each.best.bound for each in chosen)
    realised = min(each.papers.realised / each.chosen.realised for each in chosen)
    where = "in the middle" if is_centred else "elsewhere"
    return Figure(
        f"{protocol}, target {where} at 1 m and beyond: the paper's error over the chosen move's, least",
        min(each.papers.bound / each.chosen.bound for each in chosen),
        "",
        at_least(2.5) if is_centred else None,
        f"of the bounds; the best move's {possible:.2f}; of realised errors {realised:.2f}",
    )


def _over_best(result: MoveResult) -> float:
    return result.chosen.bound / result.best.bound


def _grid(results: list[MoveResult]) -> Grid:
    rows = [
        (
            f"{result.depth:g} m, {'middle' if result.is_centred else 'elsewhere'}, {result.protocol}",
            str(result.papers),
            str(result.chosen),
            str(result.best),
        )
        for result in results
    ]
    return Grid(("target", "paper's, two taps", "chosen", "best"), tuple(rows))
