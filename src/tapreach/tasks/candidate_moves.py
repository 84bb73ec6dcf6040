"""Moves that might be made, and which of them keep a target in the picture and at a distance.

A candidate is a turn on the spot and then an advance, which may be backwards. Turns are chosen by where in
the picture they put the target: sideways is where an advance makes parallax.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.robot.config import RobotDescription

COLUMNS = (0.07, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.88, 0.93)
"""Where a turn may put the target, as a share of the picture's width."""
SHARES = (0.1, 0.2, 0.3, 0.4, 0.52, 0.64, 0.76, 0.88, 1.0)
"""Advances, as a share of the longest."""
MARGIN = 0.07
"""The target stays this share of the picture away from its edges."""
NEAREST = 0.25
"""The camera comes no nearer to where the target may be [m]."""
LONGEST_TURN = math.radians(60.0)
SHORTEST_ADVANCE = 0.05
"""Nothing shorter is worth starting the wheels for [m]."""
_FINER, _HALF_FINER = 9, 5
"""So many advances, and to either side so many turns, are tried between those beside the best."""
BESIDE = 0.05
"""So far beside the way it has come the base may back off [m]."""
SIGMAS = (1.0, 1.0, 0.7)
"""What views at the stages of a move are worth [px]: two while driving, the last one at rest."""


@dataclass(frozen=True)
class Grid:
    """Candidates (t, a): every turn [rad] with every advance [m]; advances of one sign, away from zero."""

    turns: FloatArray
    advances: FloatArray

    @property
    def is_on_known_floor(self) -> npt.NDArray[np.bool_]:
        """Tell (t, a) which stay beside the straight way back, when backwards; ahead the camera sees."""
        aside = np.abs(np.sin(self.turns))[:, None] * np.maximum(-self.advances, 0.0)[None, :]
        return np.asarray(aside <= BESIDE)

    def stages_in_world(self, world_from_base: PlanarPose) -> FloatArray:
        """Return world_from_base (t, a, 3, 4, 4): after the turn, half way, and at the end."""
        stages = self.advances[:, None] * [0.0, 0.5, 1.0]
        headings = world_from_base.heading + self.turns
        c, s = np.cos(headings), np.sin(headings)
        poses = np.zeros((len(self.turns), len(self.advances), 3, 4, 4))
        poses[..., 0, 0] = poses[..., 1, 1] = c[:, None, None]
        poses[..., 1, 0], poses[..., 0, 1] = s[:, None, None], -s[:, None, None]
        poses[..., 0, 3] = world_from_base.x + c[:, None, None] * stages
        poses[..., 1, 3] = world_from_base.y + s[:, None, None] * stages
        poses[..., 2, 2] = poses[..., 3, 3] = 1.0
        return poses


def coarse_grids(
    world_from_base: PlanarPose,
    point_in_world: FloatArray,
    most_advance: float,
    most_back: float,
    description: RobotDescription,
) -> list[Grid]:
    """Return candidates that spread over everything that may be done: forwards, and backwards if allowed."""
    columns = [turn_to_column(world_from_base, point_in_world, each, description) for each in COLUMNS]
    turns = np.unique([turn for turn in columns if abs(turn) <= LONGEST_TURN])
    ways = [way for way in (most_advance, -most_back) if abs(way) >= SHORTEST_ADVANCE]
    return [Grid(turns, _advances(way)) for way in ways if len(turns)]


def finer_grid(coarse: Grid, turn: float, advance: float) -> Grid:
    """Return candidates about one of `coarse`: turns up to its neighbours, advances from the one before to
    the second one after it, as a lesser turn may allow a longer way; all longer ones, half the shorter ones.
    """
    turns = _between_neighbours(coarse.turns, turn)
    ways = np.sort(np.abs(coarse.advances))
    at = int(np.argmin(np.abs(ways - abs(advance))))
    low, high = ways[max(at - 1, 0)], ways[min(at + 2, len(ways) - 1)]
    about = np.linspace(low, high, _FINER)
    kept = np.unique(np.concatenate([ways[ways < low][::2], about, ways[ways > high]]))
    return Grid(turns, np.copysign(kept[kept >= SHORTEST_ADVANCE - 1e-12], advance))


def is_seen_and_clear(
    stages_in_world: FloatArray, point_in_world: FloatArray, description: RobotDescription
) -> npt.NDArray[np.bool_]:
    """Tell for ways (..., v, 4, 4) of the base whether the target is in the picture and not too near, on all
    of each.
    """
    points = _in_cameras(stages_in_world, point_in_world, description)
    camera = description.camera.model()
    projection = camera.project(points.reshape(-1, 3))
    share = projection.pixels / (camera.size.width, camera.size.height)
    is_inside = projection.is_inside & np.all((share >= MARGIN) & (share <= 1.0 - MARGIN), axis=1)
    is_clear = np.linalg.norm(points, axis=-1) >= NEAREST
    return np.asarray(np.all(is_inside.reshape(is_clear.shape) & is_clear, axis=-1))


def turn_to_column(
    world_from_base: PlanarPose, point_in_world: FloatArray, column: float, description: RobotDescription
) -> float:
    """Return the turn [rad] after which the point stands at this share of the picture's width."""
    camera = description.camera.model()
    wanted = math.atan2(camera.cx - column * camera.size.width, camera.fx)
    turn = 0.0
    # The camera stands ahead of the axis, so that the bearing from it changes a little with the turn.
    for _ in range(3):
        stage = Grid(np.array([turn]), np.zeros(1)).stages_in_world(world_from_base)
        x, _, z = _in_cameras(stage[0, 0, 0], point_in_world, description)
        turn += wrapped(math.atan2(-x, z) - wanted)
    return turn


def _advances(longest: float) -> FloatArray:
    shares = np.array(SHARES)
    return longest * shares[shares * abs(longest) >= SHORTEST_ADVANCE - 1e-12]


def _between_neighbours(values: FloatArray, value: float) -> FloatArray:
    at = int(np.argmin(np.abs(values - value)))
    low, high = values[max(at - 1, 0)], values[min(at + 1, len(values) - 1)]
    parts: Sequence[FloatArray] = (
        np.linspace(low, values[at], _HALF_FINER),
        np.linspace(values[at], high, _HALF_FINER),
    )
    return np.unique(np.concatenate(parts))


def _in_cameras(
    world_from_bases: FloatArray, point_in_world: FloatArray, description: RobotDescription
) -> FloatArray:
    """Return the point (..., 3) in the camera of bases (..., 4, 4)."""
    cameras = world_from_bases @ description.camera.mount.base_from_camera().as_matrix()
    offsets = point_in_world - cameras[..., :3, 3]
    return np.asarray((np.swapaxes(cameras[..., :3, :3], -1, -2) @ offsets[..., None])[..., 0])
