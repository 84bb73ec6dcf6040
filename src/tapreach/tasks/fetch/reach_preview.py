"""What is said and drawn of a fetch before anything moves."""

import math
from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.approach import Approach
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import out_of
from tapreach.tasks.fetch.reach import Verdict
from tapreach.tasks.fetch.thing import ThingSize


@dataclass(frozen=True)
class Grasp:
    """What is to be drawn of the grasp, in the world [m].

    tip_before, tip (3,): the gripping point before the arm goes out, and when it grips. fingers: inner edge
    of the left and the right finger (2, 3) each, wrist side first, while the claw is open. opening [m].
    """

    tip_before: FloatArray
    tip: FloatArray
    fingers: tuple[FloatArray, FloatArray]
    opening: float


@dataclass(frozen=True)
class ReachPreview:
    """Whether the thing can be fetched, why, and what would help ('' for nothing).

    UNSURE with an approach: driving it shows; the verdict at its last look counts. approach and grasp are
    None where there is nothing to show. size: what was planned for, supposed where `is_supposed`.
    from_another_side: the way leads to where it may be narrower; that is UNSURE also at the last look.
    """

    verdict: Verdict
    reason: str
    advice: str
    size: ThingSize | None = None
    is_supposed: bool = False
    from_another_side: bool = False
    approach: Approach | None = None
    grasp: Grasp | None = None

    @property
    def path(self) -> tuple[PlanarPose, ...]:
        """Base poses world_from_base from the start to the stand; none without a way."""
        return () if self.approach is None else self.approach.path

    @property
    def driving_seconds(self) -> float:
        """Expected time of driving [s]; 0 without a way."""
        return 0.0 if self.approach is None else self.approach.seconds


def grasp_in_world(way: Approach, body: Body) -> Grasp:
    """Return what is to be drawn of the grasp at the end of the way."""
    before, tip = way.stance.tips(body.claw)
    c, s = math.cos(way.stance.rotation), math.sin(way.stance.rotation)
    ahead, left = np.array([c, s, 0.0]), np.array([-s, c, 0.0])
    beyond, half = body.claw.beyond, way.stance.grip.opening / 2.0
    ends = np.array([tip - beyond * ahead, tip + beyond * ahead])
    fingers = ends + half * left, ends - half * left
    opening = way.stance.grip.opening
    left_finger, right_finger = (_in_world(way.stand, finger) for finger in fingers)
    before, tip = (_in_world(way.stand, point[None])[0] for point in (before, tip))
    return Grasp(before, tip, (left_finger, right_finger), opening)


def _in_world(stand: PlanarPose, points_in_base: FloatArray) -> FloatArray:
    return np.column_stack([out_of(stand, points_in_base[:, :2]), points_in_base[:, 2]])
