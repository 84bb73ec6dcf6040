"""Trials: what a robot says it did and saw, and the truth that only the scoring looks at."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.bench.accuracy_scene import (
    CAMERA,
    LEVER,
    PITCH,
    is_in_picture,
    onto_picture,
    points_in_cameras,
    poses_after,
    project,
    target_at,
)
from tapreach.bench.accuracy_taps import Taps, normal
from tapreach.errors import InputError
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pose import camera_mount

DEPTHS, VIEWS, SIGMAS_PX, ODOMETRIES = (0.5, 1.0, 2.5, 5.0), (2, 5, 20), (1.0, 3.0), (0.01, 0.03)
TURN = np.radians(12.0)
ADVANCES = {2: 0.2, 5: 0.3, 20: 0.4}
"""Whole way [m] by number of views, shortened to 0.4 of the depth; the paper's move with two."""
BEARING = np.array([-0.05, 0.05])
"""Of the target in the first camera, (X/Z, Y/Z)."""


@dataclass(frozen=True)
class Cell:
    """One setting. depth [m] in the first camera; odometry: error of each turn and advance, a fraction."""

    depth: float
    views: int
    pixel_sigma: float
    odometry: float

    @property
    def noise(self) -> OdometryNoise:
        """What the estimator is told of the odometry."""
        return OdometryNoise.per_step(self.odometry)

    def __str__(self) -> str:
        return f"{self.depth:g} m, {self.views} views, {self.pixel_sigma:g} px, {100 * self.odometry:g} %"


def all_cells() -> tuple[Cell, ...]:
    """Return the 48 settings."""
    return tuple(
        Cell(depth, views, sigma, odometry)
        for depth in DEPTHS
        for views in VIEWS
        for sigma in SIGMAS_PX
        for odometry in ODOMETRIES
    )


@dataclass(frozen=True)
class Drive:
    """What the wheels say: turns [rad] and then advances [m], (n - 1,) each, one of either in every step."""

    turns: FloatArray
    advances: FloatArray


@dataclass(frozen=True)
class Trials:
    """m trials of n views. said (m, n, 3): poses x, y [m], heading [rad] by odometry. pixels (m, n, 2).

    The truth: targets (m, 3) as bearing and inverse depth in the first camera. Observations do not hold it.
    lever (3,) [m]: the camera in the base.
    """

    said: FloatArray
    pixels: FloatArray
    pixel_sigma: float
    targets: FloatArray
    lever: FloatArray = field(default_factory=LEVER.copy)
    chance: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    """(m, 2n + 2(n - 1)): what went wrong, in sigmas: of taps, turns and advances. Of cells only."""

    @property
    def ranges(self) -> FloatArray:
        """The true distances (m,) from the first camera [m]."""
        return np.asarray(np.hypot(1.0, np.linalg.norm(self.targets[:, :2], axis=1)) / self.targets[:, 2])

    def chosen(self, numbers: npt.NDArray[np.intp]) -> "Trials":
        """Return only the trials of these numbers."""
        chance = self.chance[numbers] if len(self.chance) else self.chance
        return Trials(
            self.said[numbers],
            self.pixels[numbers],
            self.pixel_sigma,
            self.targets[numbers],
            self.lever,
            chance,
        )

    def sightings(self) -> Iterator[list[Observation]]:
        """Yield what the estimator gets of each trial."""
        mount = camera_mount(self.lever, PITCH)
        for poses, pixels in zip(self.said, self.pixels.tolist(), strict=True):
            yield [
                Observation(Pixel(u, v), self.pixel_sigma, CAMERA, base, mount)
                for base, (u, v) in zip(_bases_at(poses.tobytes()), pixels, strict=True)
            ]


@lru_cache(maxsize=4)
def _bases_at(poses: bytes) -> tuple[RigidTransform, ...]:
    """Return world_from_base for poses (n, 3); in a setting they are the same in all trials."""
    x, y, heading = np.frombuffer(poses).reshape(-1, 3).T
    matrices = np.tile(np.eye(4), (len(x), 1, 1))
    c, s = np.cos(heading), np.sin(heading)
    matrices[:, 0, 0] = matrices[:, 1, 1] = c
    matrices[:, 1, 0], matrices[:, 0, 1] = s, -s
    matrices[:, 0, 3], matrices[:, 1, 3] = x, y
    return tuple(RigidTransform.from_matrix(matrices))


def well_defined_drive(cell: Cell) -> Drive:
    """Return a turn to the left and then straight on, in even steps."""
    steps = cell.views - 1
    turns = np.zeros(steps)
    turns[0] = TURN
    return Drive(turns, np.full(steps, min(ADVANCES[cell.views], 0.4 * cell.depth) / steps))


def draw_trials(
    cell: Cell,
    count: int,
    random: np.random.Generator,
    taps: Taps = normal,
    *,
    drive: Drive | None = None,
    bearing: FloatArray = BEARING,
) -> Trials:
    """Return trials in which odometry and taps err by chance; the wheels say the same in all.

    drive: instead of `well_defined_drive`. bearing (2,): of the target. Raises InputError
    where a target would leave the picture.
    """
    drive = drive or well_defined_drive(cell)
    turns, advances = (np.tile(said, (count, 1)) for said in (drive.turns, drive.advances))
    turn_errors, advance_errors = (random.normal(size=turns.shape) for _ in range(2))
    bearings = np.tile(bearing, (count, 1))
    points = target_at(bearings, np.full(count, cell.depth))
    poses = poses_after(
        turns * (1.0 + cell.odometry * turn_errors), advances * (1.0 + cell.odometry * advance_errors)
    )
    seen = project(points_in_cameras(poses, points))
    if not np.all(is_in_picture(seen)):
        raise InputError(f"the target leaves the picture in the setting {cell}")
    tap_errors = taps(random, count, cell.views)
    return Trials(
        poses_after(turns, advances),
        onto_picture(seen + cell.pixel_sigma * tap_errors),
        cell.pixel_sigma,
        np.concatenate([bearings, np.full((count, 1), 1.0 / cell.depth)], axis=1),
        chance=np.concatenate([tap_errors.reshape(count, -1), turn_errors, advance_errors], axis=1),
    )
