"""The paper's arm in closed form: A turns it, B and C move it in a plane, and the claw stays level.

Angles: rotation about z up, left positive; shoulder 0 with the upper arm upright, positive leaning forward;
elbow relative to the upper arm, 0 at a right angle (forearm level under an upright upper arm), positive
bending down. Source: law of cosines; Craig, Introduction to Robotics, 4.4.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array, not_negative, positive

Range = tuple[float, float]
JOINT_NAMES = ("rotation", "shoulder", "elbow")
_FULL_TURN: Range = (-math.pi, math.pi)


@dataclass(frozen=True)
class ArmJoints:
    """Angles of servos A, B, C [rad]."""

    rotation: float
    shoulder: float
    elbow: float


class ReachStatus(StrEnum):
    """Whether the claw can get there."""

    REACHABLE = "reachable"
    TOO_FAR = "too_far"
    TOO_NEAR = "too_near"
    BEYOND_JOINT_RANGE = "beyond_joint_range"


@dataclass(frozen=True)
class Reach:
    """Result of the inverse: the joints where reachable; else why not, and what is missing [m or rad]."""

    status: ReachStatus
    reason: str
    joints: ArmJoints | None
    missing: float


class ArmKinematics(Protocol):
    """What an arm of three turning joints can be asked, however it is built."""

    def forward(self, joints: ArmJoints) -> FloatArray:
        """Return where the point between the finger tips is, (3,) in the base frame [m]."""
        ...

    def inverse(self, tip_in_base: npt.ArrayLike, near: ArmJoints | None = None) -> Reach:
        """Return joints that bring the finger tips to (3,) in the base frame, of several those near `near`.

        Raises InputError only for coordinates that are not finite.
        """
        ...

    def skeleton(self, joints: ArmJoints) -> FloatArray:
        """Return the ends of the links from the base outwards, (n, 3) in the base frame [m].

        The last two are the wrist and the point between the finger tips.
        """
        ...


@dataclass(frozen=True)
class ArmGeometry:
    """Sizes of the arm [m] and the ranges of its joints [rad].

    shoulder_in_base (3,): the shoulder's axis where it crosses the axis of rotation. hand: level distance
    from the wrist's axis to the point between the finger tips. Raises InputError for sizes and ranges that
    cannot be.
    """

    shoulder_in_base: tuple[float, float, float]
    upper: float
    fore: float
    hand: float
    rotation_range: Range = _FULL_TURN
    shoulder_range: Range = _FULL_TURN
    elbow_range: Range = _FULL_TURN

    def __post_init__(self) -> None:
        finite_array("shoulder_in_base", self.shoulder_in_base, (3,))
        positive("upper", self.upper)
        positive("fore", self.fore)
        not_negative("hand", self.hand)
        for name in (f"{joint}_range" for joint in JOINT_NAMES):
            low, high = finite_array(name, getattr(self, name), (2,))
            if low >= high:
                raise InputError(f"{name} is {low:g} to {high:g}; the first must be the smaller")

    def forward(self, joints: ArmJoints) -> FloatArray:
        """Return where the point between the finger tips is, (3,) in the base frame [m]."""
        tip: FloatArray = self.skeleton(joints)[-1]
        return tip

    def skeleton(self, joints: ArmJoints) -> FloatArray:
        """Return shoulder, elbow, wrist and the point between the finger tips, (4, 3) in the base [m]."""
        slope = joints.shoulder + joints.elbow
        elbow = self.upper * np.array([math.sin(joints.shoulder), math.cos(joints.shoulder)])
        wrist = elbow + self.fore * np.array([math.cos(slope), -math.sin(slope)])
        ahead_and_up = np.array([(0.0, 0.0), elbow, wrist, (wrist[0] + self.hand, wrist[1])])
        direction = np.array([math.cos(joints.rotation), math.sin(joints.rotation), 0.0])
        up = np.array([0.0, 0.0, 1.0])
        in_plane: FloatArray = ahead_and_up[:, :1] * direction + ahead_and_up[:, 1:] * up
        return in_plane + self.shoulder_in_base

    def inverse(self, tip_in_base: npt.ArrayLike, near: ArmJoints | None = None) -> Reach:
        """Return the joints that bring the finger tips to (3,) in the base frame, elbow up.

        There is one such solution, whatever `near` is. Raises InputError only for coordinates that are not
        finite.
        """
        offset = finite_array("tip_in_base", tip_in_base, (3,)) - self.shoulder_in_base
        ahead, up = math.hypot(offset[0], offset[1]) - self.hand, float(offset[2])
        length = math.hypot(ahead, up)
        too_far = length - (self.upper + self.fore)
        too_near = abs(self.upper - self.fore) - length
        if too_far > 1e-12:
            return Reach(ReachStatus.TOO_FAR, f"{_cm(too_far)} beyond reach", None, too_far)
        if too_near > 0.0 or length < 1e-9:
            return Reach(ReachStatus.TOO_NEAR, f"{_cm(too_near)} too near", None, max(too_near, 0.0))
        cosine = (length**2 - self.upper**2 - self.fore**2) / (2.0 * self.upper * self.fore)
        bend = math.acos(max(-1.0, min(1.0, cosine)))
        raised = math.atan2(up, ahead) + math.atan2(
            self.fore * math.sin(bend), self.upper + self.fore * math.cos(bend)
        )
        # bend is between the two links in line; the elbow's zero is at a right angle.
        rotation = math.atan2(offset[1], offset[0])
        return self._within_ranges(ArmJoints(rotation, math.pi / 2.0 - raised, bend - math.pi / 2.0))

    def _within_ranges(self, joints: ArmJoints) -> Reach:
        ranges = (self.rotation_range, self.shoulder_range, self.elbow_range)
        return within_ranges(joints, ranges)


def within_ranges(joints: ArmJoints, ranges: tuple[Range, Range, Range]) -> Reach:
    """Return `joints` as reached, or which of them is beyond its range [rad] and by how much."""
    for name, (low, high) in zip(JOINT_NAMES, ranges, strict=True):
        angle: float = getattr(joints, name)
        missing = max(low - angle, angle - high)
        if missing > 1e-9:
            reason = (
                f"the {name} would have to be {math.degrees(angle):.0f}°; "
                f"it goes from {math.degrees(low):.0f}° to {math.degrees(high):.0f}°"
            )
            return Reach(ReachStatus.BEYOND_JOINT_RANGE, reason, None, missing)
    return Reach(ReachStatus.REACHABLE, "within reach", joints, 0.0)


def _cm(metres: float) -> str:
    return f"{100.0 * max(metres, 0.0):.1f} cm"
