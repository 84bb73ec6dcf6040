"""From sightings to an estimate; module-level functions so that `Compute.call` can name them."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from enum import StrEnum

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.known_place import KnownPlace, from_one_view, with_known_place
from tapreach.tasks.robot_noise import mount_noise as mount_noise
from tapreach.tasks.robot_noise import odometry_noise as odometry_noise
from tapreach.tasks.sighting import Sighting, observation_of
from tapreach.tasks.straightening import Straightened, straightened


class HeadingSource(StrEnum):
    """Who said how the robot turned."""

    BACKGROUND = "background"
    WHEELS = "wheels"


@dataclass(frozen=True)
class LocatedPoint(PointEstimate):
    """An estimate from sightings, in the world of the robot's present odometry.

    The world hangs on the newest base pose: what is driven from here by the wheels arrives at
    `point_in_world`, and its covariance is that of the way from the present base (docs/decisions/0005).
    sightings: what it rests on, their poses as they are now known. base_from_camera: the mount as it is now
    known. heading_from: who said how the robot turned; for WHEELS `heading_reason` says why not the
    background.
    """

    sightings: tuple[Sighting, ...]
    base_from_camera: RigidTransform
    heading_from: HeadingSource
    heading_reason: str

    @property
    def point_in_world(self) -> FloatArray | None:
        """The target (3,) [m] in the world that the present base is exact in."""
        in_base = self.point_in_base
        return None if in_base is None else np.asarray(self._world_from_base.apply(in_base))

    @property
    def point_cov_in_world(self) -> FloatArray | None:
        """Its covariance (3, 3) [m²]."""
        covariance = self.point_cov_in_base
        if covariance is None:
            return None
        rotation = self._world_from_base.rotation.as_matrix()
        return np.asarray(rotation @ covariance @ rotation.T)

    @property
    def _world_from_base(self) -> RigidTransform:
        return self.sightings[-1].world_from_base.to_rigid()


def estimate(
    sightings: Sequence[Sighting],
    description: RobotDescription,
    with_advice: bool,
    is_newest_unconfirmed: bool = False,
    known: KnownPlace | None = None,
) -> LocatedPoint:
    """Return where the target of the sightings is, with everything that the robot's file and the background
    say of its motion.

    sightings: two or more, or one where the target's place was `known` before. is_newest_unconfirmed: the
    last one counts where it fits, and says nothing of the way where it does not.
    """
    if len(sightings) == 1 and known is not None:
        return _from_one(sightings[0], known, description)
    straight, found = _estimated(sightings, description, with_advice)
    since = _last_before_contradiction(found, len(sightings))
    if since is not None and is_newest_unconfirmed:
        return estimate(sightings[:-1], description, with_advice, known=known)
    if since is not None:
        straight, found = _estimated(sightings, description, with_advice, slipped_since=since)
    if known is not None:
        found = with_known_place(found, straight.sightings, known, description)
    source = HeadingSource.BACKGROUND if not straight.reason else HeadingSource.WHEELS
    return _located(found, straight, source)


def _from_one(sighting: Sighting, known: KnownPlace, description: RobotDescription) -> LocatedPoint:
    """Return what one view says of a place known before; nothing was driven, and nothing is said of it."""
    straight = replace(straightened([sighting], description), reason="")
    return _located(from_one_view(sighting, known, description), straight, HeadingSource.BACKGROUND)


def _located(found: PointEstimate, straight: Straightened, source: HeadingSource) -> LocatedPoint:
    values = {field.name: getattr(found, field.name) for field in fields(found)}
    return LocatedPoint(
        **values,
        sightings=straight.sightings,
        base_from_camera=straight.base_from_camera,
        heading_from=source,
        heading_reason=straight.reason,
    )


def _estimated(
    sightings: Sequence[Sighting],
    description: RobotDescription,
    with_advice: bool,
    slipped_since: int | None = None,
) -> tuple[Straightened, PointEstimate]:
    straight = straightened(sightings, description, slipped_since)
    observations = [
        observation_of(sighting, description, straight.base_from_camera) for sighting in straight.sightings
    ]
    # What lies under the tapped pixel is the target, whatever is thought of the views after it.
    found = estimate_point(observations, straight.errors, trusted=[0], with_advice=with_advice)
    return straight, found


def _last_before_contradiction(found: PointEstimate, views: int) -> int | None:
    """Return the number of the last view that fits when the newest ones do not; None when they do.

    Something is wrong from there on, and it may be the way: wheels that turn against an obstacle look the
    same to the background as wheels that drive.
    """
    fitting = [number for number in range(views) if number not in found.rejected_views]
    return fitting[-1] if fitting and fitting[-1] < views - 1 else None
