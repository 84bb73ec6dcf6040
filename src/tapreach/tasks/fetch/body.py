"""All of a robot that matters when a fetch is planned, made once from its file."""

from dataclasses import dataclass, replace

import numpy as np

from tapreach.estimation.odometry_noise import OdometryNoise, chain_errors
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import BaseSection, RobotDescription
from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.fetch.sight import Sight
from tapreach.tasks.robot_noise import odometry_noise

_QUARTER_TURN = np.pi / 2.0
_FAR, _PARTS = 8.0, 17


@dataclass(frozen=True)
class Body:
    """Wheels, outline, arm and camera; drift (n,): how far off a place may be reached that lies `ways` (n,)
    away, two sigmas [m].
    """

    base: BaseSection
    noise: OdometryNoise
    outline: Outline
    claw: Claw
    sight: Sight
    ways: FloatArray
    drift: FloatArray

    @classmethod
    def of(cls, description: RobotDescription) -> "Body":
        """Return what the robot's file says."""
        noise, ways = odometry_noise(description), np.linspace(0.0, _FAR, _PARTS)
        drift = np.array([_drift(noise, float(way)) for way in ways])
        return cls(
            description.base,
            noise,
            Outline.of(description),
            Claw.of(description),
            Sight.of(description),
            ways,
            drift,
        )

    def without_drift(self) -> "Body":
        """Return the same for ways on which the others are seen."""
        return replace(self, drift=np.zeros_like(self.drift))

    def drift_at(self, way: float) -> float:
        """Return how far off a place may be reached that lies `way` [m] away, two sigmas [m]."""
        return float(np.interp(way, self.ways, self.drift))


def covariance_of_way(noise: OdometryNoise, start: PlanarPose, end: PlanarPose) -> FloatArray:
    """Return the covariance (3, 3) of the way from one pose to the next, in the frame at its end."""
    poses = np.array([(pose.x, pose.y, pose.heading) for pose in (start, end)])
    errors = chain_errors(poses, noise)[1]
    return np.asarray(errors @ errors.T)


def _drift(noise: OdometryNoise, way: float) -> float:
    """Two sigmas of the place after a quarter turn and an advance."""
    covariance = covariance_of_way(noise, PlanarPose(), PlanarPose(0.0, way, _QUARTER_TURN))
    return 2.0 * float(np.sqrt(np.linalg.eigvalsh(covariance[:2, :2])[-1]))
