"""Any arm of turning joints in a row: where its links are, and how its tip moves with each joint.

Axes and offsets are measured in the base frame while all joints stand at 0; a turning joint carries all
that comes after it. Source: Lynch and Park, Modern Robotics, chapters 4 and 5.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class ChainJoint:
    """One joint: its axis (any length but 0), the way to it from the joint before (for the first: from the
    origin of the base) [m], and its range [rad]. Raises InputError for what cannot be.
    """

    axis: Vector
    offset: Vector
    low: float
    high: float

    @cached_property
    def unit_axis(self) -> FloatArray:
        """The axis, of length 1, (3,)."""
        unit: FloatArray = np.array(self.axis) / np.linalg.norm(self.axis)
        return unit

    def __post_init__(self) -> None:
        finite_array("offset", self.offset, (3,))
        if np.linalg.norm(finite_array("axis", self.axis, (3,))) < 1e-9:
            raise InputError(f"axis is {self.axis}; it must point somewhere")
        if finite_array("range", (self.low, self.high), (2,))[0] >= self.high:
            raise InputError(f"the range is {self.low:g} to {self.high:g}; the first must be the smaller")


@dataclass(frozen=True)
class ArmChain:
    """Joints in a row, then the way from the last of them to the wrist and from the wrist to the tip [m].

    is_hand_level: a linkage keeps the hand as it is at 0, so that it turns with the first joint alone; else
    it goes with the last. Raises InputError without joints.
    """

    joints: tuple[ChainJoint, ...]
    wrist: Vector
    hand: Vector
    is_hand_level: bool = True

    def __post_init__(self) -> None:
        if not self.joints:
            raise InputError("an arm has at least one joint; none is given")
        finite_array("wrist", self.wrist, (3,))
        finite_array("hand", self.hand, (3,))

    @property
    def ranges(self) -> FloatArray:
        """Lowest and highest angle of each joint, (n, 2) [rad]."""
        return np.array([(joint.low, joint.high) for joint in self.joints])

    def skeleton(self, angles: npt.ArrayLike) -> FloatArray:
        """Return joints, wrist and tip for angles (n,) [rad]: (n + 2, 3) in the base frame [m]."""
        return self.placed(angles)[0]

    def placed(self, angles: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the skeleton and how the tip moves with each joint, (3, n) [m/rad]."""
        turns = finite_array("angles", angles, (len(self.joints),))
        base_from_link = base_from_hand = np.eye(3)
        points, axes = [np.zeros(3)], []
        for index, (joint, angle) in enumerate(zip(self.joints, turns, strict=True)):
            points.append(points[-1] + base_from_link @ joint.offset)
            axes.append(base_from_link @ joint.unit_axis)
            base_from_link = base_from_link @ _turned(joint.unit_axis, float(angle))
            if index == 0 or not self.is_hand_level:
                base_from_hand = base_from_link
        points.append(points[-1] + base_from_link @ self.wrist)
        points.append(points[-1] + base_from_hand @ self.hand)
        skeleton = np.array(points[1:])
        return skeleton, self._carried(skeleton, np.array(axes))

    def _carried(self, skeleton: FloatArray, axes: FloatArray) -> FloatArray:
        ways = skeleton[-1] - skeleton[:-2]
        if self.is_hand_level:
            ways[1:] = skeleton[-2] - skeleton[1:-2]
        return np.array([_cross(axis, way) for axis, way in zip(axes, ways, strict=True)]).T


def _turned(axis: FloatArray, angle: float) -> FloatArray:
    """Return the rotation about a unit axis (Rodrigues); scipy's takes ten times as long for one."""
    x, y, z = axis
    skew = np.array([(0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)])
    rotation: FloatArray = np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * (skew @ skew)
    return rotation


def _cross(a: FloatArray, b: FloatArray) -> tuple[float, float, float]:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
