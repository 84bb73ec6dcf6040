"""Which candidate moves keep the base clear of things that are known to stand beside a target."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tapreach.geometry.convex import segment_distances
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.candidate_moves import Grid
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings
from tapreach.tasks.fetch.passage import TOUCH, Passage

_HERE = PlanarPose()


@dataclass(frozen=True)
class ClearMoves:
    """Obstacles of the world as a move from world_from_base must keep clear of them.

    points_in_world: where the target may be, (3,) each, the nearest first. An obstacle that may stand on the
    line between them is taken for the target itself, of which moves keep their distance anyway.
    """

    obstacles: Sequence[Obstacle]
    points_in_world: Sequence[FloatArray]
    world_from_base: PlanarPose
    description: RobotDescription

    def of(self, grid: Grid) -> npt.NDArray[np.bool_]:
        """Tell (t, a) which moves neither turn nor drive into any of them; those that stand on the robot's
        own place are not there.
        """
        is_clear = np.ones((len(grid.turns), len(grid.advances)), dtype=bool)
        if self._passage is not None:
            for row, turn in zip(is_clear, grid.turns, strict=True):
                row[:] = self._clear_advances(self._passage, float(turn), grid.advances)
        return is_clear

    def _clear_advances(self, passage: Passage, turn: float, advances: FloatArray) -> list[bool]:
        if self._may_turn_into(passage) and passage.in_the_way_of_turn(_HERE, turn) is not None:
            return [False] * len(advances)
        turned = _HERE.after(PlanarStep(turn, 0.0))
        first, after = 0, len(advances)
        # Advances lead away from zero: what is in the way of one is in the way of the next.
        while first < after:
            middle = after - 1 if after == len(advances) else (first + after) // 2
            if passage.in_the_way_of_advance(turned, float(advances[middle])) is None:
                first = middle + 1
            else:
                after = middle
        return [i < first for i in range(len(advances))]

    def _may_turn_into(self, passage: Passage) -> bool:
        """Tell whether anything is so near that the outline matters for turning."""
        around = segment_distances(
            np.zeros((1, 2)), np.zeros((1, 2)), passage.things.starts, passage.things.ends
        )
        free = around[0] - passage.things.radii - passage.body.outline.turning_radius
        return bool((free < passage.needed_at(np.zeros(2))).any())

    @cached_property
    def _passage(self) -> Passage | None:
        line = np.array([self.points_in_world[0][:2], self.points_in_world[-1][:2]])
        others = [each for each in self.obstacles if not _may_stand_on(each, line)]
        if not others:
            return None
        body, target = Body.of(self.description), Obstacle("it", line[1], line[1], 0.0, 0.0)
        passage = Passage.among(
            [each.seen_from(self.world_from_base) for each in others],
            target.seen_from(self.world_from_base),
            body,
        )
        things = passage.things
        is_apart = things.clearances(body.outline.corners) >= TOUCH
        is_apart[-1] = True
        kept = [each for each, apart in zip(things.obstacles, is_apart, strict=True) if apart]
        return Passage(body, Surroundings.of(kept), passage.needed[is_apart])


def _may_stand_on(obstacle: Obstacle, line: FloatArray) -> bool:
    apart = segment_distances(line[:1], line[1:], obstacle.start[None], obstacle.end[None])[0, 0]
    return bool(apart < obstacle.radius + obstacle.spread)
