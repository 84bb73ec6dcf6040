"""Rays in space: where they meet planes, and where they come closest."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array


@dataclass(frozen=True)
class Ray:
    """Half a line: `origin` (3,) [m] and unit `direction` (3,), in one named frame.

    A direction of any length above zero is accepted and normalised; a zero one raises InputError.
    """

    origin: FloatArray
    direction: FloatArray

    def __post_init__(self) -> None:
        direction = finite_array("ray direction", self.direction, (3,))
        length = float(np.linalg.norm(direction))
        if length == 0.0:
            raise InputError("ray direction is (0, 0, 0); it must point somewhere")
        object.__setattr__(self, "origin", finite_array("ray origin", self.origin, (3,)))
        object.__setattr__(self, "direction", direction / length)

    def at(self, distance: float) -> FloatArray:
        """Return the point (3,) at `distance` [m] from the origin."""
        return np.asarray(self.origin + distance * self.direction)

    def moved(self, a_from_b: RigidTransform) -> "Ray":
        """Return in frame a the ray given in frame b."""
        return Ray(a_from_b.apply(self.origin), a_from_b.rotation.apply(self.direction))


@dataclass(frozen=True)
class ClosestApproach:
    """Where two rays come closest: distances along each [m], negative when behind; gap [m]; midpoint (3,)."""

    along_first: float
    along_second: float
    gap: float
    midpoint: FloatArray


def closest_approach(first: Ray, second: Ray) -> ClosestApproach | None:
    """Return where two rays of one frame come closest; None where they are parallel (to 1e-9 rad).

    Source: Hartley and Zisserman, Multiple View Geometry, 12.2 (midpoint method).
    """
    across = np.cross(first.direction, second.direction)
    sine_squared = float(across @ across)
    if sine_squared < 1e-18:
        return None
    offset = second.origin - first.origin
    along_first = float(np.cross(offset, second.direction) @ across) / sine_squared
    along_second = float(np.cross(offset, first.direction) @ across) / sine_squared
    a, b = first.at(along_first), second.at(along_second)
    return ClosestApproach(along_first, along_second, float(np.linalg.norm(b - a)), (a + b) / 2.0)


def meet_plane(ray: Ray, point_on_plane: npt.ArrayLike, normal: npt.ArrayLike) -> FloatArray | None:
    """Return where the ray meets the plane (3,); None where it runs parallel to it or away from it."""
    plane_normal = finite_array("plane normal", normal, (3,))
    towards = float(plane_normal @ ray.direction)
    if abs(towards) < 1e-12 * float(np.linalg.norm(plane_normal)):
        return None
    distance = (
        float(plane_normal @ (finite_array("point_on_plane", point_on_plane, (3,)) - ray.origin)) / towards
    )
    return ray.at(distance) if distance >= 0.0 else None
