"""The paper's closed form: two taps, a turn to the left and an advance between them.

Source: Chao, Chung, Chiou and Wang, "A Simple Interface for 3D Position Estimation of a Mobile Robot with
Single Camera", Sensors 16(4), 2016; equation numbers are the paper's. It holds for a level camera on the
rotation axis; `estimate_point` holds for any other and equals it there. The target need not be on the centre
line at the first tap: its angle off the line is added to the turn, which for a centred one leaves the paper's
formulas.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, finite, positive
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarStep

_NO_ANGLE = 1e-9  # [rad], far below what any tap can show


class TwoTapStatus(StrEnum):
    """Why there is an answer or none."""

    DETERMINED = "determined"
    AT_INFINITY_OR_BEHIND = "at_infinity_or_behind"
    ZERO_ADVANCE = "zero_advance"
    NO_PARALLAX = "no_parallax"
    TARGET_BEHIND = "target_behind"


@dataclass(frozen=True)
class ScreenOffset:
    """A tap from the middle of the picture, x to the right and y up, in the unit of the focal length."""

    x: float
    y: float

    def __post_init__(self) -> None:
        for name in ("x", "y"):
            object.__setattr__(self, name, finite(f"tap {name}", getattr(self, name)))


@dataclass(frozen=True)
class TwoTapPosition:
    """Where the target is, by the closed form.

    in_first, in_second (3,) [m]: X right, Y up, Z ahead at the first tap (O, eq. 7) and the second (O_NEW,
    eq. 10). distance: OQ1 [m] on the floor plan (eq. 3). height_difference [m]: Y at O_NEW minus Y at O, eq.
    (11); zero when the taps agree. distance_per_unit: change of OQ1 [m] per unit (pixel or other) of the
    second tap's x.
    """

    in_first: FloatArray
    in_second: FloatArray
    distance: float
    height_difference: float
    distance_per_unit: float


@dataclass(frozen=True)
class TwoTapEstimate:
    """Result of the two taps: beta and phi [rad] of eqs. (5) and (6), and the position where there is one."""

    status: TwoTapStatus
    reason: str
    beta: float
    phi: float
    position: TwoTapPosition | None


def two_tap(first: ScreenOffset, second: ScreenOffset, focal: float, step: PlanarStep) -> TwoTapEstimate:
    """Return the target's position from two taps, `focal` in their unit, and the step between them.

    Raises InputError for values that are not finite and a focal length not above zero.
    """
    positive("focal length", focal)
    beta = math.atan2(second.x, focal)
    off_line = math.atan2(first.x, focal)
    turn = step.turn + off_line
    phi = math.pi / 2.0 - beta + turn
    status, reason = _status(beta, turn, step.advance)
    if status is not TwoTapStatus.DETERMINED:
        return TwoTapEstimate(status, reason, beta, phi, None)
    parallax = beta - turn
    distance = step.advance * math.sin(beta) / math.sin(parallax)  # (3) to (6), law of sines
    ahead = distance * math.cos(off_line)
    ahead_of_second = distance * math.cos(turn) - step.advance  # (9)
    in_first = ahead * np.array([first.x / focal, first.y / focal, 1.0])  # (7)
    in_second = ahead_of_second * np.array([second.x / focal, second.y / focal, 1.0])  # (10)
    slope = -step.advance * math.sin(turn) / math.sin(parallax) ** 2 * focal / (focal**2 + second.x**2)
    position = TwoTapPosition(in_first, in_second, distance, float(in_second[1] - in_first[1]), slope)
    return TwoTapEstimate(status, reason, beta, phi, position)


def two_tap_from_pixels(camera: Camera, first: Pixel, second: Pixel, step: PlanarStep) -> TwoTapEstimate:
    """Return the position from two tapped pixels, lens removed; `distance_per_unit` is per pixel."""
    rays = camera.normalise([first.to_array(), second.to_array()])
    offsets = [ScreenOffset(camera.fx * float(x), -camera.fx * float(y)) for x, y in rays]
    return two_tap(offsets[0], offsets[1], camera.fx, step)


def _status(beta: float, turn: float, advance: float) -> tuple[TwoTapStatus, str]:
    if advance == 0.0:
        return TwoTapStatus.ZERO_ADVANCE, "the advance d is 0: a turn alone gives no distance; drive some way"
    if abs(math.sin(turn)) < _NO_ANGLE:
        return TwoTapStatus.NO_PARALLAX, (
            "theta is 0: driving straight at the target gives no parallax; turn first, 12° is a good start"
        )
    parallax = beta - turn
    in_words = f"beta is {math.degrees(beta):.2f}° and theta {math.degrees(turn):.2f}°"
    if abs(parallax) < _NO_ANGLE or advance * math.sin(beta) / math.sin(parallax) <= 0.0:
        return TwoTapStatus.AT_INFINITY_OR_BEHIND, (
            f"{in_words}: the target is at infinity or behind, as the lines of sight do not meet ahead; "
            f"after a left turn beta must exceed theta; tap again or advance further"
        )
    if advance * math.cos(beta) * math.sin(turn) / math.sin(parallax) <= 0.0:
        return TwoTapStatus.TARGET_BEHIND, (
            f"{in_words}: the lines of sight meet behind the camera at the second tap; advance less"
        )
    return TwoTapStatus.DETERMINED, "the lines of sight meet ahead"
