"""The fingers of the claw as the camera should see them, by the sizes in the robot's file."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from tapreach.estimation.claw_sight import UNKNOWNS, SightModel
from tapreach.geometry.arm_clearance import ArmShape
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.vision.claw_motion import ClawPart

_BEHIND = 0.003
"""The fingers are looked at from here on [m], a little behind the point between their tips: farther back the
hand hides them."""
_BELOW = 0.2
"""Share of the half below the middle that is looked at: farther down the hand hides it."""
NO_ERRORS = np.zeros(UNKNOWNS)


@dataclass(frozen=True, eq=False)
class FingerEnd:
    """The foremost end of a finger. mark (3,): the middle of its upper edge, in the gripper's frame [m].
    by_opening: how much of an error of the claw's opening moves it to the left.
    """

    name: str
    mark: FloatArray
    by_opening: float


def finger_ends(shape: ArmShape, wide: float, narrow: float) -> dict[str, FingerEnd]:
    """Return the ends of both fingers of the claw opened to `wide` and to `narrow` [m], by their names."""
    ends = []
    for opening, word in ((wide, "open"), (narrow, "narrow")):
        aside = (opening + shape.finger_thickness) / 2.0
        for side, across in (("left", aside), ("right", -aside)):
            mark = np.array([shape.finger_beyond, across, shape.hand_radius])
            ends.append(FingerEnd(f"{side} finger of the {word} claw", mark, math.copysign(0.5, across)))
    return {end.name: end for end in ends}


def claw_parts(
    model: SightModel,
    unknowns: FloatArray,
    camera: Camera,
    sent: ArmJoints,
    ends: Sequence[FingerEnd],
    shape: ArmShape,
) -> tuple[ClawPart, ...]:
    """Return the ends that lie before the camera, for servos sent to `sent`; unknowns (10,) as SightModel has
    them.
    """
    parts = []
    for end in ends:
        points = np.vstack([_corners(end.mark, shape), end.mark])
        by_opening = np.full(len(points), end.by_opening)
        seen = camera.project(model.in_camera(unknowns, sent, points, by_opening))
        if seen.is_valid.all():
            parts.append(ClawPart(end.name, seen.pixels[:-1], seen.pixels[-1]))
    return tuple(parts)


def _corners(mark: FloatArray, shape: ArmShape) -> FloatArray:
    """Return the corners (8, 3) of what is looked at of a finger."""
    across = (mark[1] - shape.finger_thickness / 2.0, mark[1] + shape.finger_thickness / 2.0)
    return np.array(list(product((-_BEHIND, mark[0]), across, (-_BELOW * mark[2], mark[2]))))
