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
_TURNS_DEG = (0, 6, -6, 12, -12, 20, -20)


def advice_to_halve(
    observations: Sequence[Observation],
    motion: Motion,
    mount_noise: MountNoise | None,
    point_in_world: FloatArray,
    relative_sd: float,
    nuisances: NuisancePriors | None = None,
    tap_noise: TapNoise | None = None,
) -> str:
    """Return the shortest next move that halves the error of 1/Z at `point_in_world`, or what the best gains.

    Moves are a turn on the spot and an advance with one more view at the end, the target kept in the picture.
    """
    steps = [PlanarStep(math.radians(turn), advance) for advance in _ADVANCES for turn in _TURNS_DEG]
    bases = observations[-1].world_from_base.as_matrix() @ np.array([_matrix(step) for step in steps])
    found = relative_sds_after(
        observations, motion, mount_noise, point_in_world, bases, nuisances=nuisances, tap_noise=tap_noise
    ).tolist()
    best: tuple[float, PlanarStep] | None = None
    for first in range(0, len(steps), len(_TURNS_DEG)):
        same_advance = slice(first, first + len(_TURNS_DEG))
        pairs = zip(found[same_advance], steps[same_advance], strict=True)
        scored = [pair for pair in pairs if math.isfinite(pair[0])]
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


def _matrix(step: PlanarStep) -> FloatArray:
    """Return before_from_after (4, 4)."""
    c, s = math.cos(step.turn), math.sin(step.turn)
    x, y = step.advance * c, step.advance * s
    return np.array([[c, -s, 0.0, x], [s, c, 0.0, y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def _in_words(step: PlanarStep) -> str:
    drive = f"drive {100.0 * step.advance:.0f} cm"
    if step.turn == 0.0:
        return drive
    side = "left" if step.turn > 0.0 else "right"
    return f"turn {abs(math.degrees(step.turn)):.0f}° {side} and {drive}"
