"""A place known from an earlier look, and what it adds to a new one: how far away the thing is.

The direction is seen anew. What was wrong with it then, the camera's mount, is wrong with it now: counted
twice it would look surer than it is. So the old direction only tells whether this is the same place.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.estimation.point_in_frames import GivenInFrames, UncertainPoint
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.optics import optics_of
from tapreach.tasks.robot_noise import mount_noise
from tapreach.tasks.sighting import Sighting, observation_of
from tapreach.tasks.way_error import by_way

_SAME_SIGMAS = 3.5
"""What is seen farther from where it was known to be is something else, or has been moved far."""
_NEAREST = 0.05
"""A place this near to the camera's plane cannot be compared with a line of sight [m]."""
_SIGMAS_95 = 1.96
_MOST_RELATIVE_SD = 0.4
"""Beyond this an interval about the distance means nothing."""
_REASON = "its distance was known from before"


@dataclass(frozen=True, eq=False)
class KnownPlace:
    """Where something was, in the world of the odometry: point (3,) [m], covariance (3, 3) [m²].

    known_at: the base then, by the wheels: what they have done wrong since is not in the covariance.
    """

    point_in_world: FloatArray
    cov_in_world: FloatArray
    known_at: PlanarPose

    def seen_from(self, here: PlanarPose, description: RobotDescription) -> "KnownPlace":
        """Return it as known from a base at `here`, less surely by what the wheels did on the way there."""
        added = by_way(self.known_at, here, self.point_in_world, description)
        return KnownPlace(self.point_in_world, self.cov_in_world + added, here)

    def less_sure(self, times: float) -> "KnownPlace":
        """Return it with sigmas so many times as large."""
        return replace(self, cov_in_world=times**2 * self.cov_in_world)

    def perhaps_moved(self, across_sd: float, up_sd: float) -> "KnownPlace":
        """Return it after something may have moved it on the floor and up or down, one sigma each [m]."""
        added = np.diag(np.square([across_sd, across_sd, up_sd]))
        return replace(self, cov_in_world=self.cov_in_world + added)

    def perhaps_along(self, along: float, sd: float) -> "KnownPlace":
        """Return it known less surely along a direction on the floor of the world [rad], by one sigma [m]."""
        way = sd * np.array([math.cos(along), math.sin(along), 0.0])
        return replace(self, cov_in_world=self.cov_in_world + np.outer(way, way))


@dataclass(frozen=True, eq=False)
class _Sight:
    """A place as a camera sees it: (X/Z, Y/Z, 1/Z) (3,), and its covariance (3, 3)."""

    mean: FloatArray
    cov: FloatArray


def with_known_place(
    found: PointEstimate, sightings: Sequence[Sighting], known: KnownPlace, description: RobotDescription
) -> PointEstimate:
    """Return the estimate with the distance that was known before; `found` as it is where that says nothing:
    the thing is seen somewhere else, or its views contradict each other.

    sightings: what `found` rests on, at least one, in the order of time, their poses as now known. known: in
    the world that the newest of them hangs in. Range, bearing and relative sd are told for the first view.
    """
    if found.status not in (Status.DETERMINED, Status.RANGE_BOUNDED_BELOW, Status.DEGENERATE):
        return found
    newest = sightings[-1]
    base_from_world = np.linalg.inv(newest.world_from_base.to_rigid().as_matrix())
    there = known.seen_from(newest.world_from_base, description)
    mount = optics_of(description.camera)[2]
    camera_from_base: FloatArray = np.linalg.inv(mount).astype(float)
    before = _sight(there.point_in_world, there.cov_in_world, camera_from_base @ base_from_world)
    if before is None:
        return found
    seen = _seen(found, newest, camera_from_base, float(before.mean[2]), description)
    if seen is None or not _is_same(seen, before, found):
        return found
    fused = _at_depth(seen, float(before.mean[2]), float(before.cov[2, 2]))
    in_base = _placed(fused).moved(mount)
    world_from_base = newest.world_from_base.to_rigid().as_matrix()
    in_frames = GivenInFrames(in_base.moved(world_from_base), in_base)
    return _answer(found, in_frames, sightings[0], description)


def from_one_view(sighting: Sighting, known: KnownPlace, description: RobotDescription) -> PointEstimate:
    """Return what a single view tells together with the place known before."""
    alone = estimate_point([observation_of(sighting, description)], with_advice=False)
    return with_known_place(alone, [sighting], known, description)


def _seen(
    found: PointEstimate,
    newest: Sighting,
    camera_from_base: FloatArray,
    likely_inverse_depth: float,
    description: RobotDescription,
) -> _Sight | None:
    """Return the target in the newest camera by the new views alone: of infinite variance in depth where they
    do not tell it. likely_inverse_depth [1/m]: how much a shift of the camera would move it in the picture.
    """
    if found.status is Status.DETERMINED and found.in_frames is not None:
        base = found.in_frames.base
        return _sight(base.point, base.covariance, camera_from_base)
    camera = optics_of(description.camera)[0]
    bearing = camera.normalise([newest.pixel.to_array()])[0]
    mount = mount_noise(description)
    by_shift = mount.position_sigma * likely_inverse_depth
    sd = math.hypot(newest.sigma / camera.fx, mount.angle_sigma, by_shift)
    return _Sight(np.array([*bearing, 0.0]), np.diag([sd**2, sd**2, math.inf]))


def _sight(point: FloatArray, covariance: FloatArray, camera_from_there: FloatArray) -> _Sight | None:
    """Return how a camera sees a point (3,) [m]; None behind it or as good as beside it."""
    rotation = camera_from_there[:3, :3]
    x, y, z = rotation @ point + camera_from_there[:3, 3]
    if z < _NEAREST:
        return None
    by_point = np.array([[1.0, 0.0, -x / z], [0.0, 1.0, -y / z], [0.0, 0.0, -1.0 / z]]) @ rotation / z
    return _Sight(np.array([x / z, y / z, 1.0 / z]), by_point @ covariance @ by_point.T)


def _is_same(seen: _Sight, before: _Sight, found: PointEstimate) -> bool:
    """Tell whether what is seen can be what was known, by its direction and by its distance."""
    off = seen.mean - before.mean
    across = off[:2] @ np.linalg.solve(seen.cov[:2, :2] + before.cov[:2, :2], off[:2])
    if across > _SAME_SIGMAS**2:
        return False
    if found.status is Status.DETERMINED:
        return bool(off[2] ** 2 <= _SAME_SIGMAS**2 * (seen.cov[2, 2] + before.cov[2, 2]))
    least = found.range_interval_95[0] if found.range_interval_95 is not None else 0.0
    nearest = max(float(before.mean[2]) - _SAME_SIGMAS * math.sqrt(before.cov[2, 2]), 1e-3)
    return least < math.hypot(*seen.mean[:2], 1.0) / nearest


def _at_depth(seen: _Sight, inverse_depth: float, variance: float) -> _Sight:
    """Return the sight with an inverse depth [1/m] known besides: one step of a Kalman filter."""
    if math.isinf(seen.cov[2, 2]):
        cov = seen.cov.copy()
        cov[2, 2] = variance
        return _Sight(np.array([*seen.mean[:2], inverse_depth]), cov)
    gain = seen.cov[:, 2] / (seen.cov[2, 2] + variance)
    mean = seen.mean + gain * (inverse_depth - seen.mean[2])
    return _Sight(mean, seen.cov - np.outer(gain, seen.cov[2]))


def _placed(sight: _Sight) -> UncertainPoint:
    """Return where it is in the camera's frame."""
    a, b, rho = sight.mean
    in_camera = np.array([a, b, 1.0]) / rho
    by_sight = np.array([[1.0, 0.0, -a / rho], [0.0, 1.0, -b / rho], [0.0, 0.0, -1.0 / rho]]) / rho
    return UncertainPoint(in_camera, by_sight @ sight.cov @ by_sight.T)


def _answer(
    found: PointEstimate, in_frames: GivenInFrames, first: Sighting, description: RobotDescription
) -> PointEstimate:
    """Return the estimate of a point, as the first view sees it."""
    mount = optics_of(description.camera)[2]
    world_from_camera = first.world_from_base.to_rigid().as_matrix() @ mount
    world = in_frames.world
    sight = _sight(world.point, world.covariance, np.linalg.inv(world_from_camera).astype(float))
    away = world.point - world_from_camera[:3, 3]
    distance = float(np.linalg.norm(away))
    relative_sd = math.sqrt(float(away @ world.covariance @ away)) / distance**2
    if sight is None or relative_sd > _MOST_RELATIVE_SD:
        return found
    spread = _SIGMAS_95 * relative_sd
    return replace(
        found,
        status=Status.DETERMINED,
        reason=_REASON if found.status is not Status.DETERMINED else found.reason,
        bearing=sight.mean[:2],
        inverse_depth=float(sight.mean[2]),
        bearing_inverse_depth_cov=sight.cov,
        relative_sd=relative_sd,
        range=distance,
        range_interval_95=(distance / (1.0 + spread), distance / (1.0 - spread)),
        in_frames=in_frames,
    )
