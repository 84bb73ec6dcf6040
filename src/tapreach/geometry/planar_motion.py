"""Poses and motion on the floor plane: what a wheeled base can do."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.finite import finite


@dataclass(frozen=True)
class PlanarPose:
    """A pose on the floor: x, y [m] and heading [rad, to the left], of `b` in `a` where named a_from_b.

    The heading is kept as given, not wrapped, so that turns can be counted. Raises InputError for NaN.
    """

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def __post_init__(self) -> None:
        for name in ("x", "y", "heading"):
            object.__setattr__(self, name, finite(name, getattr(self, name)))

    def compose(self, other: "PlanarPose") -> "PlanarPose":
        """Return a_from_c for self = a_from_b and other = b_from_c."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return PlanarPose(
            self.x + c * other.x - s * other.y,
            self.y + s * other.x + c * other.y,
            self.heading + other.heading,
        )

    def inverse(self) -> "PlanarPose":
        """Return b_from_a for self = a_from_b."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return PlanarPose(-c * self.x - s * self.y, s * self.x - c * self.y, -self.heading)

    def between(self, other: "PlanarPose") -> "PlanarPose":
        """Return b_from_c for self = a_from_b and other = a_from_c: the way to `other` as seen from here."""
        return self.inverse().compose(other)

    def after_arc(self, distance: float, turn: float) -> "PlanarPose":
        """Return the pose after driving `distance` [m] along an arc that turns by `turn` [rad]; exact."""
        # np.sinc(x) is sin(pi x)/(pi x): chord = distance · sin(turn/2)/(turn/2), also for no turn at all.
        chord = finite("distance", distance) * float(np.sinc(finite("turn", turn) / (2.0 * math.pi)))
        return self.compose(PlanarPose(chord * math.cos(turn / 2.0), chord * math.sin(turn / 2.0), turn))

    def after(self, step: "PlanarStep") -> "PlanarPose":
        """Return the pose after turning on the spot and then advancing."""
        return self.compose(step.to_pose())

    def towards(self, other: "PlanarPose", fraction: float) -> "PlanarPose":
        """Return the pose at `fraction` of the way to `other`, at constant twist (the arc between them).

        Turns of pi and more between the two are ambiguous as arcs; there x, y and heading go linearly.
        """
        way = self.between(other)
        half = way.heading / 2.0
        if abs(half) >= math.pi / 2.0:
            return self.compose(PlanarPose(fraction * way.x, fraction * way.y, fraction * way.heading))
        stretch = half / math.tan(half) if half != 0.0 else 1.0
        forward, sideways = stretch * way.x + half * way.y, stretch * way.y - half * way.x
        along = PlanarPose().after_arc(fraction, fraction * way.heading)
        return self.compose(
            PlanarPose(
                along.x * forward - along.y * sideways,
                along.y * forward + along.x * sideways,
                fraction * way.heading,
            )
        )

    def to_rigid(self) -> RigidTransform:
        """Return the same pose in space, on the floor z = 0."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        matrix = [[c, -s, 0.0, self.x], [s, c, 0.0, self.y], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        # Rigid as it is: finding that out by a singular value decomposition takes eight times as long.
        return RigidTransform(np.array(matrix), normalize=False)

    @classmethod
    def from_rigid(cls, pose: RigidTransform) -> "PlanarPose":
        """Return the floor pose below `pose`: its x, y, and the heading of its x axis (-pi to pi)."""
        matrix = pose.as_matrix()
        return cls(matrix[0, 3], matrix[1, 3], math.atan2(matrix[1, 0], matrix[0, 0]))


@dataclass(frozen=True)
class PlanarStep:
    """Turn on the spot by `turn` [rad, left], then advance by `advance` [m]: the paper's steps 2 and 3."""

    turn: float
    advance: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "turn", finite("turn", self.turn))
        object.__setattr__(self, "advance", finite("advance", self.advance))

    def to_pose(self) -> PlanarPose:
        """Return before_from_after."""
        return PlanarPose(self.advance * math.cos(self.turn), self.advance * math.sin(self.turn), self.turn)


def wrapped(angle: float) -> float:
    """Return the same direction in (-pi, pi] [rad]."""
    turned = math.remainder(finite("angle", angle), 2.0 * math.pi)
    return math.pi if turned == -math.pi else turned
