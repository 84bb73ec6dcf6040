"""From sightings to an estimate and to the next move; module-level functions so that `Compute.call` can
name them.
"""

from collections.abc import Sequence
from math import radians

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.robot.config import RobotDescription
from tapreach.tasks.sighting import Sighting, observation_of


def odometry_noise(description: RobotDescription) -> OdometryNoise:
    """Return how far this robot's file says its odometry is to be trusted."""
    base = description.base
    return OdometryNoise(
        turn_per_sqrt_m=radians(base.drift_sigma_deg_per_m),
        advance_scale=base.distance_sigma,
        turn_scale=base.turn_sigma,
    )


def mount_noise(description: RobotDescription) -> MountNoise:
    """Return how well the camera's place on this robot is known."""
    mount = description.camera.mount
    return MountNoise(mount.position_sigma, radians(mount.angle_sigma_deg))


def estimate(
    sightings: Sequence[Sighting], description: RobotDescription, with_advice: bool
) -> PointEstimate:
    """Return where the target of the sightings is, with everything that the robot's file says of its
    errors.
    """
    observations = [observation_of(sighting, description) for sighting in sightings]
    return estimate_point(
        observations,
        odometry_noise(description),
        mount_noise=mount_noise(description),
        with_advice=with_advice,
    )
