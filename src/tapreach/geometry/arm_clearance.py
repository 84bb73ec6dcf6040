"""How far the arm is from the floor and from the robot's own base: links as capsules, the base as boxes."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array, not_negative, positive

SPACING = 0.002
"""Links are looked at in points this far apart [m]: distances are right to half of it."""


@dataclass(frozen=True)
class ArmShape:
    """Thickness of the arm [m].

    link_radius: of the links. hand_radius: half the height of hand and fingers. finger_beyond: how far the
    fingers reach beyond the point between their tips by which the arm is steered. finger_thickness: of one
    finger, across. palm_width: of the hand at the wrist, across. Raises InputError for sizes that cannot be.
    """

    link_radius: float
    hand_radius: float
    finger_beyond: float
    finger_thickness: float
    palm_width: float

    def __post_init__(self) -> None:
        positive("link_radius", self.link_radius)
        positive("hand_radius", self.hand_radius)
        not_negative("finger_beyond", self.finger_beyond)
        positive("finger_thickness", self.finger_thickness)
        not_negative("palm_width", self.palm_width)


@dataclass(frozen=True)
class BodyBox:
    """A part of the base by its lowest and highest corner, (3,) each in the base frame [m]."""

    name: str
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    def __post_init__(self) -> None:
        low, high = finite_array("low", self.low, (3,)), finite_array("high", self.high, (3,))
        if np.any(low >= high):
            raise InputError(f"box {self.name!r} goes from {self.low} to {self.high}; it must have a size")


@dataclass(frozen=True)
class Capsule:
    """All that is within `radius` [m] of the line from `start` to `end`, (3,) each in the base frame [m]."""

    name: str
    start: FloatArray
    end: FloatArray
    radius: float


@dataclass(frozen=True)
class Clearance:
    """The least distance [m] (negative: they run into each other), and between what."""

    distance: float
    part: str
    other: str


def arm_capsules(skeleton: FloatArray, claw: float, shape: ArmShape) -> tuple[Capsule, ...]:
    """Return the solids of an arm with this skeleton (n, 3) (see ArmKinematics) and this opening [m]."""
    links = [
        Capsule("arm", start, end, shape.link_radius)
        for start, end in pairwise(skeleton[:-1])
        if np.linalg.norm(end - start) > 1e-9
    ]
    return (_off_the_base(links[0]), *links[1:], *_hand(skeleton, claw, shape))


def clearance(capsules: Sequence[Capsule], boxes: Sequence[BodyBox]) -> Clearance:
    """Return what of the arm is nearest to the floor or to one of the boxes, to 1 mm."""
    lines = [_along(capsule) for capsule in capsules]
    points = np.concatenate(lines)
    owners = np.repeat(np.arange(len(capsules)), [len(line) for line in lines])
    radii = np.array([capsule.radius for capsule in capsules])[owners]
    # One column for the floor, then one for each box.
    ways = np.column_stack([points[:, 2], *_from_boxes(points, boxes)]) - radii[:, None]
    row, column = np.unravel_index(np.argmin(ways), ways.shape)
    others = ["floor", *(box.name for box in boxes)]
    return Clearance(float(ways[row, column]), capsules[int(owners[row])].name, others[int(column)])


def _off_the_base(link: Capsule) -> Capsule:
    """Leave out the end by which the arm stands on the base: it is near the base at all times."""
    way = link.end - link.start
    share = min(0.5, 2.0 * link.radius / float(np.linalg.norm(way)))
    return Capsule(link.name, link.start + share * way, link.end, link.radius)


def _hand(skeleton: FloatArray, claw: float, shape: ArmShape) -> tuple[Capsule, Capsule, Capsule]:
    wrist, tip = skeleton[-2:]
    ahead = (tip - wrist) / max(float(np.linalg.norm(tip - wrist)), 1e-9)
    across = np.cross((0.0, 0.0, 1.0), ahead) / max(float(np.hypot(*ahead[:2])), 1e-9)
    # As wide as it is; inside, where only the thing to be gripped is, the capsules may overlap.
    aside = max(0.0, claw / 2.0 + shape.finger_thickness - shape.hand_radius) * across
    # The round end of the capsule reaches as far as the finger does.
    end = tip + max(0.0, shape.finger_beyond - shape.hand_radius) * ahead
    left = Capsule("claw", wrist + aside, end + aside, shape.hand_radius)
    right = Capsule("claw", wrist - aside, end - aside, shape.hand_radius)
    half_palm = max(0.0, shape.palm_width / 2.0 - shape.hand_radius) * across
    return left, right, Capsule("claw", wrist + half_palm, wrist - half_palm, shape.hand_radius)


def _along(capsule: Capsule) -> FloatArray:
    """Return points (n, 3) on the middle line of a capsule, its ends among them."""
    count = 2 + int(np.linalg.norm(capsule.end - capsule.start) / SPACING)
    return np.linspace(capsule.start, capsule.end, count)


def _from_boxes(points: FloatArray, boxes: Sequence[BodyBox]) -> FloatArray:
    """Return how far each of the points (n, 3) is from each box, (boxes, n); inside, less than 0."""
    low = np.array([box.low for box in boxes]).reshape(-1, 1, 3)
    high = np.array([box.high for box in boxes]).reshape(-1, 1, 3)
    outside = np.maximum(low - points, points - high)
    beyond = np.sqrt(np.sum(np.maximum(outside, 0.0) ** 2, axis=2))
    distances: FloatArray = beyond + np.minimum(np.max(outside, axis=2), 0.0)
    return distances
