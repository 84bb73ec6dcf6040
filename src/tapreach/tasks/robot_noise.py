"""How far a robot's file says that its odometry and its camera's mount are to be trusted."""

from math import radians

from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.robot.config import RobotDescription


def odometry_noise(description: RobotDescription) -> OdometryNoise:
    """Return how far this robot's file says its odometry is to be trusted."""
    base = description.base
    return OdometryNoise(
        advance_per_sqrt_m=base.distance_sigma_per_sqrt_m,
        turn_per_sqrt_rad=radians(base.turn_sigma_deg_per_sqrt_rad),
        turn_per_sqrt_m=radians(base.drift_sigma_deg_per_m),
        slip_per_sqrt_m=base.sideways_sigma_per_sqrt_m,
        advance_scale=base.distance_sigma,
        turn_scale=base.turn_sigma,
        creep_per_rad=base.creep_sigma_per_rad,
    )


def mount_noise(description: RobotDescription) -> MountNoise:
    """Return how well the camera's place on this robot is known."""
    mount = description.camera.mount
    return MountNoise(mount.position_sigma, radians(mount.angle_sigma_deg))
