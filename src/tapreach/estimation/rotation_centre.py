"""Is the projection centre on the rotation axis? A near and a far point on the axis tell.

When they are, both keep one column after a turn on the spot. A camera ahead of the axis moves sideways as the
base turns, and the near point's column moves further than the far one's. The paper names this check.
"""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, finite, positive

_ITERATIONS = 30
_LONGEST_LEVER = 2.0  # [m]; a solution beyond it is no lever of this kind of robot


@dataclass(frozen=True)
class ColumnShift:
    """One point's column u [px] before and after the turn, and its depth [m] before it, with one sigma."""

    before: float
    after: float
    depth: float
    depth_sigma: float = 0.0

    def __post_init__(self) -> None:
        for name in ("before", "after"):
            finite(f"column {name}", getattr(self, name))
        positive("depth", self.depth)
        finite("depth_sigma", self.depth_sigma)


@dataclass(frozen=True)
class RotationCentre:
    """How far the projection centre lies ahead of the rotation axis: lever [m], and the turn made [rad].

    Sigmas are one standard deviation. is_on_axis: the lever is within two sigmas of zero.
    """

    lever: float
    lever_sigma: float
    turn: float
    turn_sigma: float

    @property
    def is_on_axis(self) -> bool:
        """True where the check shows no lever."""
        return abs(self.lever) <= 2.0 * self.lever_sigma


def rotation_centre(
    camera: Camera, near: ColumnShift, far: ColumnShift, pixel_sigma: float = 1.0
) -> RotationCentre | None:
    """Return lever and turn from two points seen before and after a turn on the spot, level camera.

    None where the two points cannot tell: depths too alike, no turn, or columns that no lever explains.
    Raises InputError where `near` is not the nearer one.
    """
    if near.depth >= far.depth:
        raise InputError(
            f"near depth is {near.depth:g} m and far {far.depth:g} m; near must be the smaller one"
        )
    shifts = (near, far)
    tangents = camera.normalise([[u, camera.cy] for shift in shifts for u in (shift.before, shift.after)])
    before, after = tangents[0::2, 0], tangents[1::2, 0]
    unknowns = np.array([math.atan(after[1]) - math.atan(before[1]), 0.0])
    for _ in range(_ITERATIONS):
        errors, slopes, _ = _equations(unknowns, before, after, shifts)
        if abs(float(np.linalg.det(slopes))) < 1e-6:
            return None
        step = np.linalg.solve(slopes, errors)
        unknowns = unknowns - step
        if abs(float(unknowns[1])) > _LONGEST_LEVER:
            return None
        if float(np.abs(step).max()) < 1e-12:
            return _result(unknowns, before, after, shifts, pixel_sigma / camera.fx)
    return None


def _equations(
    unknowns: FloatArray, before: FloatArray, after: FloatArray, shifts: tuple[ColumnShift, ColumnShift]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return errors (2,), their derivative by (turn, lever) (2, 2) and by (before, after, depth) (2, 3)."""
    turn, lever = float(unknowns[0]), float(unknowns[1])
    c, s = math.cos(turn), math.sin(turn)
    depth = np.array([shift.depth for shift in shifts])
    right = depth * before
    across = right * c + (lever + depth) * s
    ahead = (lever + depth) * c - right * s - lever
    errors = across - after * ahead
    by_turn = (lever + depth) * c - right * s + after * ((lever + depth) * s + right * c)
    by_lever = s - after * (c - 1.0)
    by_before = depth * c + after * depth * s
    by_depth = before * c + s - after * (c - before * s)
    return errors, np.stack([by_turn, by_lever], axis=1), np.stack([by_before, -ahead, by_depth], axis=1)


def _result(
    unknowns: FloatArray,
    before: FloatArray,
    after: FloatArray,
    shifts: tuple[ColumnShift, ColumnShift],
    column_sigma: float,
) -> RotationCentre:
    _, slopes, by_measured = _equations(unknowns, before, after, shifts)
    variances = np.array([[column_sigma**2, column_sigma**2, shift.depth_sigma**2] for shift in shifts])
    spread = np.diag(np.sum(by_measured**2 * variances, axis=1))
    inverse = np.linalg.inv(slopes)
    turn_sigma, lever_sigma = np.sqrt(np.diag(inverse @ spread @ inverse.T))
    return RotationCentre(float(unknowns[1]), float(lever_sigma), float(unknowns[0]), float(turn_sigma))
