"""Trials: what a robot says it did and saw, and the truth that only the scoring looks at."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
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
from tapreach.geometry.planar_motion import PlanarPose
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

    @property
    def ranges(self) -> FloatArray:
        """The true distances (m,) from the first camera [m]."""
        return np.asarray(np.hypot(1.0, np.linalg.norm(self.targets[:, :2], axis=1)) / self.targets[:, 2])

    def chosen(self, numbers: npt.NDArray[np.intp]) -> "Trials":
        """Return only the trials of these numbers."""
        return replace(
            self, said=self.said[numbers], pixels=self.pixels[numbers], targets=self.targets[numbers]
        )

    def sightings(self) -> Iterator[list[Observation]]:
        """Yield what the estimator gets of each trial."""
        mount = camera_mount(self.lever, PITCH)
        for poses, pixels in zip(self.said.tolist(), self.pixels.tolist(), strict=True):
            yield [
                Observation(Pixel(u, v), self.pixel_sigma, CAMERA, _base_at(*pose), mount)
                for pose, (u, v) in zip(poses, pixels, strict=True)
            ]


@lru_cache(maxsize=256)
def _base_at(x: float, y: float, heading: float) -> RigidTransform:
    return PlanarPose(x, y, heading).to_rigid()


def well_defined_steps(cell: Cell) -> tuple[FloatArray, FloatArray]:
    """Return turns [rad] and advances [m], (n - 1,): a turn to the left and then straight on, evenly."""
    steps = cell.views - 1
    turns = np.zeros(steps)
    turns[0] = TURN
    return turns, np.full(steps, min(ADVANCES[cell.views], 0.4 * cell.depth) / steps)


def draw_trials(cell: Cell, count: int, random: np.random.Generator, taps: Taps = normal) -> Trials:
    """Return trials in which odometry and taps err by chance; the wheels say the same in all.

    Raises InputError where a target would leave the picture.
    """
    turns, advances = (np.tile(said, (count, 1)) for said in well_defined_steps(cell))
    true_turns = turns * (1.0 + cell.odometry * random.normal(size=turns.shape))
    true_advances = advances * (1.0 + cell.odometry * random.normal(size=advances.shape))
    bearings = np.tile(BEARING, (count, 1))
    points = target_at(bearings, np.full(count, cell.depth))
    seen = project(points_in_cameras(poses_after(true_turns, true_advances), points))
    if not np.all(is_in_picture(seen)):
        raise InputError(f"the target leaves the picture in the setting {cell}")
    pixels = onto_picture(seen + cell.pixel_sigma * taps(random, count, cell.views))
    targets = np.concatenate([bearings, np.full((count, 1), 1.0 / cell.depth)], axis=1)
    return Trials(poses_after(turns, advances), pixels, cell.pixel_sigma, targets)
