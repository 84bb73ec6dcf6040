"""What to do next for a better answer, computed from the bound."""

import math
from collections.abc import Sequence

import numpy as np

from tapreach.estimation.motion_prior import Motion, MountNoise
from tapreach.estimation.next_view import relative_sds_after
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.tap_noise import TapNoise
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarStep

_ADVANCES = (0.03, 0.06, 0.12, 0.2, 0.3, 0.45, 0.6)
_TURNS_DEG = (0, 6, -6, 12, -12, 20, -20, 35, -35)
_NEAREST = 0.2
"""No advice brings the camera nearer to the target [m]."""
_HELPFUL = 0.9
"""An error no smaller than this share of what it is does not make a move worth advising."""
_ALMOST_UNKNOWN = 0.5
"""A relative error this large is told in percent alone."""


def advice_to_halve(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    relative_sd: float,
    nuisances: NuisancePriors | None = None,
    tap_noise: TapNoise | None = None,
) -> str:
    """Return the shortest next move that halves the error of 1/Z at `point_in_world`, or what the best gains,
    in metres and percent (one sigma).

    Moves are a turn on the spot and an advance with one more view at the end, the target kept in the picture
    and at a distance.
    """
    steps = [PlanarStep(math.radians(turn), advance) for advance in _ADVANCES for turn in _TURNS_DEG]
    bases = observations[-1].world_from_base.as_matrix() @ np.array([_matrix(step) for step in steps])
    sds = relative_sds_after(
        observations, motion, mount_noise, point_in_world, bases, nuisances=nuisances, tap_noise=tap_noise
    )
    cameras = bases @ observations[-1].base_from_camera.as_matrix()
    sds[np.linalg.norm(cameras[:, :3, 3] - point_in_world, axis=1) < _NEAREST] = np.inf
    if not np.isfinite(sds).any():
        return "turn until the target is nearer the middle of the picture"
    distance = float(np.linalg.norm(point_in_world - observations[0].world_from_camera.translation))
    halving = _shortest_that_halves(sds, relative_sd)
    best = int(np.argmin(sds)) if halving is None else halving
    error = _error(sds[best], distance)
    if halving is not None:
        return f"{_in_words(steps[best])} more to halve the error: {error}"
    if sds[best] > _HELPFUL * relative_sd:
        return f"more views from here bring {error} at best; look from another side"
    return f"{_in_words(steps[best])} more for {error}"


def _shortest_that_halves(sds: FloatArray, relative_sd: float) -> int | None:
    """Return the step with the shortest advance: straight ahead where that does, else the best turn."""
    for first in range(0, len(sds), len(_TURNS_DEG)):
        same_advance = sds[first : first + len(_TURNS_DEG)]
        if same_advance[0] <= 0.5 * relative_sd:
            return first
        if same_advance.min() <= 0.5 * relative_sd:
            return first + int(np.argmin(same_advance))
    return None


def _error(relative_sd: float, distance: float) -> str:
    percent = f"{100.0 * relative_sd:.2g} %"
    return percent if relative_sd > _ALMOST_UNKNOWN else f"±{relative_sd * distance:.3f} m ({percent})"


def _matrix(step: PlanarStep) -> FloatArray:
    """Return before_from_after (4, 4)."""
    c, s = math.cos(step.turn), math.sin(step.turn)
    x, y = step.advance * c, step.advance * s
    return np.array([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def _in_words(step: PlanarStep) -> str:
    drive = f"drive {step.advance:.2f} m"
    if step.turn == 0.0:
        return drive
    side = "left" if step.turn > 0.0 else "right"
    return f"turn {abs(math.degrees(step.turn)):.0f}° {side} and {drive}"
