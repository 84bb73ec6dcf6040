"""Which move tells most about a target that must stay in the picture.

About a hundred candidates are scored at once by the bound on the range that the views on the way and at the
end would leave, over the supposed distances of the target; then some more around the two best turns.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tapreach.estimation.next_view import relative_sds_after
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.candidate_moves import SIGMAS, Grid, coarse_grids, finer_grid, is_seen_and_clear
from tapreach.tasks.clear_moves import ClearMoves
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.going_back import LostSide
from tapreach.tasks.optics import optics_of
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import Sighting, observation_of

Score = Callable[[FloatArray, FloatArray], FloatArray]
"""From a target (3,) and world_from_base along c moves (c, 3, 4, 4), as Grid has them, to sd(1/Z)·Z (c,)."""
SEEN_TURN = math.radians(0.15)
"""What is left of the error of a turn [rad/√rad], [rad/√m] where the background is followed."""
_VALLEYS = 2
"""So many turns are refined."""
_NOTHING = 1.0
"""What is known, as sd(1/Z)·Z, of a target for which not even the shortest advance can be made."""


@dataclass(frozen=True, slots=True)
class MoveCosts:
    """What driving [1/m] and turning [1/rad] cost, in units of the logarithm of the range's relative error.

    good_enough: relative errors below this are worth no more way.
    """

    per_metre: float = 0.4
    per_radian: float = 0.1
    good_enough: float = 0.0


@dataclass(frozen=True, slots=True)
class Room:
    """What may be driven ahead and back [m]."""

    ahead: float
    behind: float


FREE_OF_CHARGE = MoveCosts(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Choice:
    """A move and what it promises for a target in the middle of the supposed distances.

    relative_sd: sd(1/Z)·Z. distance: from the camera as it is now [m]. cost: by which it was chosen; the
    lower of two was the better.
    """

    step: PlanarStep
    relative_sd: float
    distance: float
    cost: float

    @property
    def sd(self) -> float:
        """One sigma of the range that it promises [m]."""
        return self.relative_sd * self.distance


def choose_move(
    sightings: Sequence[Sighting],
    world_from_base: PlanarPose,
    points_in_world: Sequence[FloatArray],
    most_advance: float,
    description: RobotDescription,
    *,
    most_back: float = 0.0,
    costs: MoveCosts | None = None,
    score: Score | None = None,
    keep_clear: Sequence[Obstacle] = (),
    lost_sides: Sequence[LostSide] = (),
) -> Choice | None:
    """Return the best turn and advance from `world_from_base`; None when none keeps the target in view.

    points_in_world: where the target may be, (3,) each, equally likely, the nearest first. The move keeps the
    middle one in the picture and at a distance, or a farther one when that cannot be; for each of the others
    it counts as far as it can be made. most_advance, most_back [m]: what may be driven. costs: MoveCosts()
    when left out. score: the bound under the robot file's errors when left out. keep_clear: what else stands
    there, in the world; the base turns and drives into none of it. lost_sides: no move ends there.
    """
    search = _Search(
        world_from_base,
        points_in_world,
        description,
        costs or MoveCosts(),
        score or bound_score(sightings, description),
        ClearMoves(keep_clear, points_in_world, world_from_base, description),
        lost_sides,
    )
    for kept in range(len(points_in_world) // 2, len(points_in_world)):
        grids = coarse_grids(world_from_base, points_in_world[kept], most_advance, most_back, description)
        found = [each for grid in grids if (each := search.best(grid, kept)) is not None]
        if found:
            return min(found, key=lambda choice: choice.cost)
    return None


def planned_move(
    sightings: Sequence[Sighting],
    world_from_base: PlanarPose,
    points_in_world: Sequence[FloatArray],
    room: Room,
    accuracy: float,
    turns_are_seen: bool,
    description: RobotDescription,
    keep_clear: Sequence[Obstacle] = (),
    lost_sides: Sequence[LostSide] = (),
) -> Choice | None:
    """Return `choose_move` as a task wants it: everything that goes in can travel to another process."""
    return choose_move(
        sightings,
        world_from_base,
        points_in_world,
        room.ahead,
        description,
        most_back=room.behind,
        costs=MoveCosts(good_enough=accuracy),
        score=bound_score(sightings, description, turns_are_seen),
        keep_clear=keep_clear,
        lost_sides=lost_sides,
    )


def bound_score(
    sightings: Sequence[Sighting], description: RobotDescription, turns_are_seen: bool = False
) -> Score:
    """Return the score by the Cramér-Rao bound of what was sighted together with what a move would show.

    turns_are_seen: the background tells the turns better than the wheels do.
    """
    known = [observation_of(sighting, description) for sighting in sightings]
    motion, mount = odometry_noise(description), mount_noise(description)
    if turns_are_seen:
        motion = replace(motion, turn_scale=0.0, turn_per_sqrt_rad=SEEN_TURN, turn_per_sqrt_m=SEEN_TURN)
    return lambda point, ways: relative_sds_after(known, motion, mount, point, ways, SIGMAS)


@dataclass(frozen=True)
class _Search:
    world_from_base: PlanarPose
    points_in_world: Sequence[FloatArray]
    description: RobotDescription
    costs: MoveCosts
    score: Score
    clear: ClearMoves
    lost_sides: Sequence[LostSide]

    def best(self, coarse: Grid, kept: int) -> Choice | None:
        """Return the best candidate of a grid, refined; None when the point `kept` forbids them all.

        The farthest that a turn may advance lies between the advances of the grid, so that another turn than
        the best of the grid may be the best: it is refined about each of the two best valleys.
        """
        choices = [self._refined(coarse, choice, kept) for choice in self._best_of(coarse, kept)[:_VALLEYS]]
        return min(choices, key=lambda choice: choice.cost, default=None)

    def _refined(self, grid: Grid, choice: Choice, kept: int) -> Choice:
        for _ in range(3):
            grid = finer_grid(grid, choice.step.turn, choice.step.advance)
            choice = min([choice, *self._best_of(grid, kept)[:1]], key=lambda each: each.cost)
        return choice

    def _best_of(self, grid: Grid, kept: int) -> list[Choice]:
        """Return the best candidate in each valley of the turns, the best of all first."""
        relative_sds = np.array([self._relative_sds(grid, point) for point in self.points_in_world])
        useful = np.maximum(_as_far_as_possible(relative_sds), max(self.costs.good_enough, 1e-9))
        costs = (
            np.log(useful).mean(axis=0)
            + self.costs.per_radian * np.abs(grid.turns)[:, None]
            + self.costs.per_metre * np.abs(grid.advances)[None, :]
        )
        costs[~(np.isfinite(relative_sds[kept]) & self.clear.of(grid) & self._in_sight_from(grid))] = np.inf
        distance = self._distance(self.points_in_world[kept])
        return [
            Choice(
                PlanarStep(float(grid.turns[turn]), float(grid.advances[advance])),
                float(relative_sds[kept, turn, advance]),
                distance,
                float(costs[turn, advance]),
            )
            for turn in _valleys(costs.min(axis=1))
            for advance in [int(np.argmin(costs[turn]))]
        ]

    def _relative_sds(self, grid: Grid, point_in_world: FloatArray) -> FloatArray:
        """Return sd(1/Z)·Z (t, a) after each candidate; infinite where the target would be lost or hit."""
        stages = grid.stages_in_world(self.world_from_base)
        can_be_made = is_seen_and_clear(stages, point_in_world, self.description) & grid.is_on_known_floor
        found = np.full(can_be_made.shape, np.inf)
        if can_be_made.any():
            found[can_be_made] = self.score(point_in_world, stages[can_be_made])
        return found

    def _in_sight_from(self, grid: Grid) -> npt.NDArray[np.bool_]:
        """Tell (t, a) which moves do not end on a side from which the target is hidden."""
        if not self.lost_sides:
            return np.ones((len(grid.turns), len(grid.advances)), dtype=bool)
        ends = grid.stages_in_world(self.world_from_base)[:, :, -1] @ optics_of(self.description.camera)[2]
        hidden = [side.hides_from(ends[..., :3, 3]) for side in self.lost_sides]
        return np.asarray(~np.any(hidden, axis=0))

    def _distance(self, point_in_world: FloatArray) -> float:
        mount = self.description.camera.mount.base_from_camera()
        camera = (self.world_from_base.to_rigid() * mount).translation
        return float(np.linalg.norm(point_in_world - camera))


def _valleys(costs: FloatArray) -> list[int]:
    """Return where finite costs (t,) are no higher than beside, the lowest first."""
    beside = np.concatenate([[np.inf], costs, [np.inf]])
    low = np.flatnonzero(np.isfinite(costs) & (costs <= beside[:-2]) & (costs <= beside[2:]))
    return [int(each) for each in low[np.argsort(costs[low])]]


def _as_far_as_possible(relative_sds: FloatArray) -> FloatArray:
    """Return (p, t, a) with each advance that a point forbids counted as the longest one it allows."""
    made = relative_sds.copy()
    made[..., 0] = np.where(np.isfinite(made[..., 0]), made[..., 0], _NOTHING)
    for i in range(1, made.shape[-1]):
        made[..., i] = np.where(np.isfinite(made[..., i]), made[..., i], made[..., i - 1])
    return made
