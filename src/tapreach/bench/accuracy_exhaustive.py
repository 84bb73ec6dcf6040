"""The best move there is, by trying them all: every turn and advance that keeps the target in the picture.

By the bench's own bound, so that it shares nothing with the chooser but the limits that are to be kept.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.bench.accuracy_linear import linear
from tapreach.bench.accuracy_scene import (
    HEIGHT,
    WIDTH,
    is_in_picture,
    points_in_cameras,
    poses_after,
    project,
    target_at,
)
from tapreach.bench.accuracy_trials import Drive
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarStep

MOST_ADVANCE = 0.5
_TURNS = np.radians(np.arange(-60.0, 60.01, 0.5))
_ADVANCES = np.arange(0.03, MOST_ADVANCE + 1e-9, 0.01)
_FINER = np.linspace(-1.0, 1.0, 11)


@dataclass(frozen=True)
class Views:
    """At which shares of the advance there are views after the turn; the last is 1. One more is before."""

    shares: tuple[float, ...]

    def drive(self, turns: FloatArray, advances: FloatArray) -> Drive:
        """Return the steps (c, v) between the views of moves (c,)."""
        parts = np.diff(self.shares, prepend=0.0)
        first = np.eye(len(parts))[0]
        return Drive(turns[..., None] * first, advances[..., None] * parts)


TWO_TAPS = Views((1.0,))
ON_THE_WAY = Views((0.0, 0.5, 1.0))


@dataclass(frozen=True)
class Sight:
    """A target (3,), bearing and inverse depth in the first camera, and what errs: taps [px], odometry."""

    target: FloatArray
    pixel_sigma: float
    odometry: float


@dataclass(frozen=True)
class Keeping:
    """What a move must keep: the target off the picture's edges, a share of its size, and so far away [m]."""

    margin: float
    nearest: float


def relative_sds(sight: Sight, views: Views, turns: FloatArray, advances: FloatArray) -> FloatArray:
    """Return the bound on sd(1/Z)·Z (c,) of moves (c,)."""
    sigmas = np.full(len(views.shares) + 1, sight.pixel_sigma)
    experiment = linear(views.drive(turns, advances), sight.target, sigmas, sight.odometry)
    return np.asarray(experiment.inverse_depth_sd / sight.target[2])


def best_move(sight: Sight, views: Views, keeping: Keeping) -> tuple[PlanarStep, float]:
    """Return the best of all moves and its sd(1/Z)·Z; a grid of 0.5° and 1 cm, made finer at its minimum."""
    turns, advances = (each.ravel() for each in np.meshgrid(_TURNS, _ADVANCES))
    step, sd = PlanarStep(0.0, 0.0), math.inf
    for width in ((np.radians(0.5), 0.01), (np.radians(0.1), 0.002)):
        kept = _are_kept(sight, turns, advances, keeping)
        turns, advances = turns[kept], advances[kept]
        found = relative_sds(sight, views, turns, advances)
        best = int(np.argmin(found))
        step, sd = PlanarStep(float(turns[best]), float(advances[best])), float(found[best])
        around = np.meshgrid(step.turn + width[0] * _FINER, step.advance + width[1] * _FINER)
        turns, advances = around[0].ravel(), np.clip(around[1].ravel(), 0.03, MOST_ADVANCE)
    return step, sd


def is_kept(sight: Sight, step: PlanarStep, keeping: Keeping) -> bool:
    """Tell whether the target stays in the picture and away throughout a move."""
    return bool(_are_kept(sight, np.array([step.turn]), np.array([step.advance]), keeping)[0])


def _are_kept(
    sight: Sight, turns: FloatArray, advances: FloatArray, keeping: Keeping
) -> npt.NDArray[np.bool_]:
    drive = ON_THE_WAY.drive(turns, advances)
    targets = np.tile(sight.target, (len(turns), 1))
    points = points_in_cameras(
        poses_after(drive.turns, drive.advances), target_at(targets[:, :2], 1.0 / targets[:, 2])
    )[:, 1:]
    pixels = project(points)
    inside = is_in_picture(pixels)
    size = np.array([WIDTH, HEIGHT])
    share = pixels / size
    inside &= np.all((share >= keeping.margin) & (share <= 1.0 - keeping.margin), axis=-1)
    is_clear = np.linalg.norm(points, axis=-1) >= keeping.nearest
    return np.asarray(np.all(inside & is_clear, axis=-1))
