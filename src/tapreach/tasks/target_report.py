"""From an estimate to the target that the page shows."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.ray import Ray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import HeadingSource, LocatedPoint
from tapreach.tasks.extent import extent_of
from tapreach.tasks.present_base import PresentPoint, at_present
from tapreach.tasks.sighting import Passed, Sighting, rays_of
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.task import Tap

_SIGMAS_95 = 1.96


@dataclass(frozen=True)
class TargetReport:
    """What stays the same while a target is worked on."""

    target_id: int
    source: TargetSource
    tap: Tap
    description: RobotDescription

    def target(
        self,
        sightings: Sequence[Sighting],
        estimate: PointEstimate | None,
        is_following: bool,
        reason: str = "",
        here: PlanarPose | None = None,
        way: Sequence[Sighting | Passed] = (),
    ) -> Target:
        """Return the target as it stands; `reason` replaces the estimate's own.

        here: the base by the wheels, where it has moved on since the newest sighting. way: see at_present.
        """
        here = sightings[-1].world_from_base if here is None else here
        present = None
        if isinstance(estimate, LocatedPoint):
            sightings = estimate.sightings
            present = at_present(estimate, here, self.description, way)
        point = _point(estimate, present)
        rays = rays_of(sightings, self.description)
        return Target(
            target_id=self.target_id,
            source=self.source,
            status=str(estimate.status) if estimate is not None else "following",
            reason=_reason(reason, estimate),
            advice=estimate.advice if estimate is not None else "",
            frame_id=self.tap.frame_id,
            u=self.tap.u,
            v=self.tap.v,
            point_in_world=point,
            point_cov_in_world=_covariance(estimate, present),
            range=floor_distance(here, point) if point is not None else None,
            range_interval=_widened(_range_interval(here, rays, estimate), here, present),
            rays_in_world=rays,
            is_following=is_following,
            extent=extent_of(self.tap.box, sightings[0], estimate, self.description),
        )


def _point(estimate: PointEstimate | None, present: PresentPoint | None) -> FloatArray | None:
    if present is not None:
        return present.point_in_world
    return estimate.point_in_world if estimate is not None else None


def _covariance(estimate: PointEstimate | None, present: PresentPoint | None) -> FloatArray | None:
    if present is not None:
        return present.cov_in_world
    return estimate.point_cov_in_world if estimate is not None else None


def _reason(given: str, estimate: PointEstimate | None) -> str:
    """Return what is said of the answer; and, where the wheels alone tell how the robot turned, why."""
    reason = given or (estimate.reason if estimate is not None else "")
    if not isinstance(estimate, LocatedPoint) or estimate.point_in_world is None:
        return reason
    if estimate.heading_from is HeadingSource.BACKGROUND:
        return reason
    return "; ".join(filter(None, [reason, f"turns by the wheels alone ({estimate.heading_reason})"]))


def floor_distance(world_from_base: PlanarPose, point_in_world: np.ndarray) -> float:
    """Return the distance on the floor from the base's origin to below the point [m]."""
    return math.hypot(
        float(point_in_world[0]) - world_from_base.x, float(point_in_world[1]) - world_from_base.y
    )


def _range_interval(
    here: PlanarPose, rays: Sequence[Ray], estimate: PointEstimate | None
) -> tuple[float, float] | None:
    """Carry the interval along the reference ray over to the distance from where the base is now.

    The ray is laid through the estimated point, which rests on better poses than the ray itself.
    """
    if estimate is None or estimate.range_interval_95 is None:
        return None
    ray, point = rays[0], estimate.point_in_world
    aside = 0.0 if point is None or estimate.range is None else point - ray.at(estimate.range)
    near, far = estimate.range_interval_95
    distances = [
        floor_distance(here, ray.at(near) + aside),
        math.inf if far is None else floor_distance(here, ray.at(far) + aside),
    ]
    if point is not None:
        distances.append(floor_distance(here, point))
    return min(distances), max(distances)


def _widened(
    interval: tuple[float, float] | None, here: PlanarPose, present: PresentPoint | None
) -> tuple[float, float] | None:
    """Return the 95 % interval of the range with what the way since the newest sighting adds."""
    if interval is None or present is None:
        return interval
    point = present.point_in_world
    middle, ahead = floor_distance(here, point), point - (here.x, here.y, point[2])
    if middle == 0.0:
        return interval
    by_way = _SIGMAS_95 * present.way_sd_along(ahead / middle)
    low, high = interval
    return max(0.0, middle - math.hypot(middle - low, by_way)), middle + math.hypot(high - middle, by_way)
