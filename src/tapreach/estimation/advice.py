"""What to do next for a better answer, computed from the bound."""

import math
from collections.abc import Sequence

import numpy as np

from tapreach.estimation.bound import position_bound
from tapreach.estimation.motion_prior import Motion, MountNoise
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarStep

_ADVANCES = (0.03, 0.06, 0.12, 0.2, 0.3, 0.45, 0.6)
_TURNS_DEG = (0, 6, -6, 12, -12, 20, -20)


def advice_to_halve(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    relative_sd: float,
) -> str:
    """Return the shortest next move that halves the error of 1/Z at `point_in_world`, or what the best gains.

    Moves are a turn on the spot and an advance with one more view at the end, the target kept in the picture.
    """
    best: tuple[float, PlanarStep] | None = None
    for advance in _ADVANCES:
        scored = [
            (sd, PlanarStep(math.radians(turn), advance))
            for turn in _TURNS_DEG
            if (sd := _after(observations, motion, mount_noise, point_in_world, turn, advance)) is not None
        ]
        for sd, step in scored[:1] + sorted(scored[1:], key=lambda pair: pair[0]):
            if sd <= 0.5 * relative_sd:
                return f"{_in_words(step)} more to halve the error"
            if best is None or sd < best[0]:
                best = sd, step
    if best is None:
        return "turn until the target is nearer the middle of the picture"
    if best[0] > 0.9 * relative_sd:
        return "more views of this kind will hardly help; look from another side"
    return f"{_in_words(best[1])} more for an error {100.0 * (1.0 - best[0] / relative_sd):.0f} % smaller"


def _after(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    turn_deg: float,
    advance: float,
) -> float | None:
    """Return the relative sd after the move; None where the target would leave the picture."""
    last = observations[-1]
    world_from_base = last.world_from_base * PlanarStep(math.radians(turn_deg), advance).to_pose().to_rigid()
    camera_from_world = (world_from_base * last.base_from_camera).inv()
    projection = last.camera.project(camera_from_world.apply(point_in_world)[None])
    if not projection.is_inside[0]:
        return None
    u, v = projection.pixels[0]
    seen = Observation(
        Pixel(float(u), float(v)), last.pixel_sigma, last.camera, world_from_base, last.base_from_camera
    )
    bound = position_bound([*observations, seen], point_in_world, _extended(motion), mount_noise)
    return None if bound is None else bound.relative_sd


def _extended(motion: Motion) -> Motion:
    """Return the motion's noise with one more pose; poses given with a covariance gain one without error."""
    if motion is None or isinstance(motion, OdometryNoise):
        return motion
    given = np.asarray(motion, dtype=np.float64)
    if given.ndim == 3:
        return np.concatenate([given, given[-1:]])
    larger = np.zeros((len(given) + 6, len(given) + 6))
    larger[:-6, :-6] = given
    larger[-6:, -6:] = given[-6:, -6:]
    return larger


def _in_words(step: PlanarStep) -> str:
    drive = f"drive {100.0 * step.advance:.0f} cm"
    if step.turn == 0.0:
        return drive
    side = "left" if step.turn > 0.0 else "right"
    return f"turn {abs(math.degrees(step.turn)):.0f}° {side} and {drive}"
