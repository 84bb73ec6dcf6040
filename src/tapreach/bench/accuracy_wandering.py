"""Trials of random motions, and of motions that cannot tell the depth."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tapreach.bench.accuracy_scene import (
    FOCAL,
    HEIGHT,
    LEVER,
    PITCH,
    PRINCIPAL,
    WIDTH,
    is_in_picture,
    onto_picture,
    points_in_cameras,
    poses_after,
    project,
    target_at,
)
from tapreach.bench.accuracy_trials import Trials
from tapreach.geometry.finite import FloatArray

NEAREST, FARTHEST = 0.2, 10.0
"""Of the targets from the camera [m], even odds over the logarithm."""
_CENTRED = np.array([0.0, 0.0, LEVER[2]])
_LARGEST_TURN, _LARGEST_ADVANCE = 0.5, 0.5


@dataclass(frozen=True)
class Steps:
    """turns [rad], advances [m] (m, n - 1) as the wheels report them; targets; the camera in the base [m]."""

    turns: FloatArray
    advances: FloatArray
    bearings: FloatArray
    depths: FloatArray
    lever: FloatArray


Motion = Callable[[np.random.Generator, int, int], Steps]
"""From generator, trials m and views n."""


def wandering(random: np.random.Generator, trials: int, views: int) -> Steps:
    """Any turn up to 29° and advance up to 50 cm, either way, each left out now and then."""
    shape = (trials, views - 1)
    turns = random.uniform(-_LARGEST_TURN, _LARGEST_TURN, shape) * (random.random(shape) < 0.8)
    advances = random.uniform(-0.5, 1.0, shape) * _LARGEST_ADVANCE * (random.random(shape) < 0.8)
    bearings = _bearings(random, trials)
    depths = _ranges(random, trials) / np.hypot(1.0, np.linalg.norm(bearings, axis=1))
    return Steps(turns, advances, bearings, depths, LEVER)


def standing(random: np.random.Generator, trials: int, views: int) -> Steps:
    """No motion at all: singular."""
    still = np.zeros((trials, views - 1))
    return Steps(still, still, _bearings(random, trials), _ranges(random, trials), LEVER)


def turning_about_the_camera(random: np.random.Generator, trials: int, views: int) -> Steps:
    """Turning on the spot with the camera on the axis: singular."""
    turns = random.uniform(-0.2, 0.2, (trials, views - 1))
    still = np.zeros_like(turns)
    return Steps(turns, still, _bearings(random, trials), _ranges(random, trials), _CENTRED)


def along_the_line_of_sight(random: np.random.Generator, trials: int, views: int) -> Steps:
    """Straight at a target as high as the camera: singular."""
    depths = _ranges(random, trials)
    shares = random.uniform(0.02, 0.6, (trials, views - 1))
    advances = (
        shares / shares.sum(axis=1, keepdims=True) * (depths * random.uniform(0.05, 0.5, trials))[:, None]
    )
    bearings = np.tile([0.0, -np.tan(PITCH)], (trials, 1))
    return Steps(np.zeros_like(advances), advances, bearings, depths, LEVER)


def hardly_moving(random: np.random.Generator, trials: int, views: int) -> Steps:
    """A nanometre to a micrometre, turning as little: no better than not at all."""
    shape = (trials, views - 1)
    size = 10.0 ** random.uniform(-9.0, -6.0, (trials, 1)) / (views - 1)
    advances = size * random.uniform(-1.0, 1.0, shape)
    turns = size * random.uniform(-1.0, 1.0, shape)
    return Steps(turns, advances, _bearings(random, trials), _ranges(random, trials), LEVER)


SINGULAR: dict[str, Motion] = {
    "standing": standing,
    "turning about the camera": turning_about_the_camera,
    "along the line of sight": along_the_line_of_sight,
}


def draw_motions(
    kind: Motion, trials: int, views: int, pixel_sigma: float, odometry: float, random: np.random.Generator
) -> Trials:
    """Return the trials; motions that lose the target are drawn again."""
    said: list[FloatArray] = []
    pixels: list[FloatArray] = []
    targets: list[FloatArray] = []
    while sum(map(len, said)) < trials:
        steps = kind(random, 4 * trials, views)
        seen, is_seen = _sighted(steps, odometry, random)
        said.append(poses_after(steps.turns, steps.advances)[is_seen])
        pixels.append(onto_picture(seen[is_seen] + pixel_sigma * random.normal(size=seen[is_seen].shape)))
        targets.append(np.column_stack([steps.bearings, 1.0 / steps.depths])[is_seen])
    drawn = [np.concatenate(parts)[:trials] for parts in (said, pixels, targets)]
    return Trials(drawn[0], drawn[1], pixel_sigma, drawn[2], steps.lever)


def tapped_anywhere(trials: Trials, random: np.random.Generator) -> Trials:
    """Return the trials with taps that have nothing to do with each other: many lines of sight diverge."""
    pixels = random.uniform([0.0, 0.0], [WIDTH - 1.0, HEIGHT - 1.0], trials.pixels.shape)
    return replace(trials, pixels=pixels)


def _sighted(steps: Steps, odometry: float, random: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    turns = steps.turns * (1.0 + odometry * random.normal(size=steps.turns.shape))
    advances = steps.advances * (1.0 + odometry * random.normal(size=steps.advances.shape))
    points = target_at(steps.bearings, steps.depths, steps.lever)
    seen = project(points_in_cameras(poses_after(turns, advances), points, steps.lever))
    return seen, np.all(is_in_picture(seen), axis=1)


def _bearings(random: np.random.Generator, trials: int) -> FloatArray:
    pixels = random.uniform([0.0, 0.0], [WIDTH - 1.0, HEIGHT - 1.0], (trials, 2))
    return np.asarray((pixels - PRINCIPAL) / FOCAL)


def _ranges(random: np.random.Generator, trials: int) -> FloatArray:
    return np.exp(random.uniform(np.log(NEAREST), np.log(FARTHEST), trials))
