"""Whether turns, advances and the open claw keep clear of known things."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tapreach.geometry.convex import convex_hull
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.body import Body
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings, out_of
from tapreach.tasks.fetch.stand import Stance

CLEAR = 0.02
"""The base keeps so far from where things may stand [m], besides what odometry may drift."""
CLAW_CLEAR = 0.008
"""The claw on its last stretch keeps so far from them [m]."""
TOUCH = 0.003
"""What is nearer than this when the way begins is not driven past at all [m]."""


@dataclass(frozen=True)
class Passage:
    """Known things in the frame of the base at the start of the way, and how far to keep from them.

    The last of them is what is fetched: the base keeps clear of it as of the others, the claw does not, and
    since it is followed on the way no drift counts. needed (m,): way to keep from each [m] before drift is
    added; things that are nearer already may not come nearer still.
    """

    body: Body
    things: Surroundings
    needed: FloatArray

    @classmethod
    def among(cls, others_here: Sequence[Obstacle], goal_here: Obstacle, body: Body) -> "Passage":
        """Return the passage from the origin to what is fetched, among others, all seen from there.

        A region that reaches over the robot itself is cut down to its middle: it is not where the robot is.
        """
        obstacles_here = (*others_here, goal_here)
        here = body.outline.corners
        overlaps = Surroundings.of(obstacles_here).clearances(here) < TOUCH
        kept = [
            replace(each, start=each.centre, end=each.centre, spread=0.0) if overlap else each
            for each, overlap in zip(obstacles_here, overlaps, strict=True)
        ]
        things = Surroundings.of(kept)
        return cls(body, things, np.clip(things.clearances(here), TOUCH, CLEAR))

    @cached_property
    def drifts(self) -> FloatArray:
        """(m,): how far off the base may be where it passes each on its far side, two sigmas [m]."""
        things = self.things
        ends = np.hypot(*np.stack([things.starts, things.ends]).transpose(2, 0, 1)).max(axis=0)
        ways = ends + things.radii + self.body.outline.turning_radius
        return np.array([self.body.drift_at(float(way)) for way in ways])

    @property
    def touching(self) -> Obstacle | None:
        """What the robot touches where it stands, if anything."""
        return self._first(
            self.things.clearances(self.body.outline.corners), np.full(len(self.needed), TOUCH)
        )

    def in_the_way_of_turn(self, pose: PlanarPose, turn: float) -> Obstacle | None:
        """Return what is too near to turn on the spot; None for nothing."""
        if turn == 0.0:
            return None
        clear = self.body.outline.turn_clearances(pose, turn, self.things)
        return self._first(clear, self._needed(pose))

    def in_the_way_of_advance(self, pose: PlanarPose, distance: float) -> Obstacle | None:
        """Return what is too near to drive straight by `distance`; None for nothing."""
        swept = self.body.outline.swept_by_advance(pose, distance)
        return self._first(self.things.clearances(swept), self._needed(pose.after(PlanarStep(0.0, distance))))

    def in_the_way_of_claw(self, last_look: PlanarPose, stand: PlanarPose, stance: Stance) -> Obstacle | None:
        """Return what the open claw would push while the base drives up and the arm goes out."""
        drawn_back = claw_at(stance, stance.grip.pre_grasp, self.body)
        out = claw_at(stance, stance.grip.ahead, self.body)
        driven = convex_hull(np.concatenate([out_of(last_look, drawn_back), out_of(stand, drawn_back)]))
        extended = convex_hull(np.concatenate([out_of(stand, drawn_back), out_of(stand, out)]))
        clear = np.minimum(self.things.clearances(driven), self.things.clearances(extended))
        needed = np.full(len(self.needed), CLAW_CLEAR)
        needed[-1] = -np.inf
        return self._first(clear, needed)

    def needed_at(self, place: FloatArray) -> FloatArray:
        """Return (m,): the way to keep from each on the way to (2,) [m], with what odometry may drift up to
        there, or up to where it is passed if that is nearer.
        """
        drift = np.minimum(self.body.drift_at(float(np.hypot(*place))), self.drifts)
        needed = np.where(self.needed >= CLEAR, self.needed + drift, self.needed)
        needed[-1] = self.needed[-1]
        return np.asarray(needed)

    def _needed(self, pose: PlanarPose) -> FloatArray:
        return self.needed_at(np.array([pose.x, pose.y]))

    def _first(self, clear: FloatArray, needed: FloatArray) -> Obstacle | None:
        """Return the one that lacks most, or None where none lacks anything."""
        lacking = needed - clear
        # A hair, since what just does at rest is computed again along the way.
        if lacking.max() <= 1e-9:
            return None
        return self.things.obstacles[int(np.argmax(lacking))]


def claw_at(stance: Stance, ahead: float, body: Body) -> FloatArray:
    """Return the corners (4, 2) of the open claw, wrist to finger tips, in the base frame."""
    c, s = np.cos(stance.rotation), np.sin(stance.rotation)
    half = body.claw.outer_width(stance.grip.opening) / 2.0
    along = np.array([ahead - body.claw.beyond, ahead + body.claw.beyond])
    corners = np.array([(along[0], -half), (along[1], -half), (along[1], half), (along[0], half)])
    return np.asarray(corners @ np.array([[c, s], [-s, c]]) + body.claw.turret)
