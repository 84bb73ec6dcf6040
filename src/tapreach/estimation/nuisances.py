"""Things taken as known that are not quite: one error each, shared by all views (docs/estimation.md, 3)."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, not_negative


@dataclass(frozen=True)
class NuisancePriors:
    """One sigma of each; zero, the default, takes the thing as exact. Zero or more each, else InputError.

    Wheel scales need poses of a base that drives on the plane of its x and y axes. They add to what an
    OdometryNoise says, as the mount's errors add to a MountNoise.
    """

    focal_scale: float = 0.0  # of both focal lengths, a fraction
    turn_scale: float = 0.0  # of all turns together, a fraction
    distance_scale: float = 0.0  # of all advances together, a fraction
    lever: float = 0.0  # of each coordinate of the camera on the base [m]
    yaw: float = 0.0  # of the camera on the base, about the vertical of the base [rad]
    pitch: float = 0.0  # about the camera's axis to the right [rad]
    roll: float = 0.0  # about the optical axis [rad]

    def __post_init__(self) -> None:
        for each in fields(self):
            object.__setattr__(self, each.name, not_negative(each.name, getattr(self, each.name)))

    @property
    def scales_the_wheels(self) -> bool:
        """True where turns or advances as a whole may be wrong."""
        return self.turn_scale > 0.0 or self.distance_scale > 0.0

    @property
    def moves_the_mount(self) -> bool:
        """True where the camera may sit elsewhere on the base."""
        return max(self.lever, self.yaw, self.pitch, self.roll) > 0.0


def mount_columns(mounts: FloatArray, priors: NuisancePriors) -> FloatArray:
    """Return (n, 6, q): what one sigma of lever, yaw, pitch and roll does to cameras on mounts (n, 4, 4).

    Right perturbation of the camera, (translation, rotation).
    """
    rotations = np.swapaxes(mounts[:, :3, :3], 1, 2)
    columns = np.zeros((len(mounts), 6, 6))
    columns[:, :3, :3] = priors.lever * rotations
    columns[:, 3:, 3] = priors.yaw * rotations[:, :, 2]
    columns[:, 3, 4], columns[:, 5, 5] = -priors.pitch, priors.roll
    return columns[:, :, np.any(columns != 0.0, axis=(0, 1))]


def focal_columns(cameras: Sequence[Camera], pixels: FloatArray, sigma: float) -> FloatArray:
    """Return (n, 2, 1): by how much [px] one sigma of the focal lengths moves what is at pixels (n, 2)."""
    principal = np.array([(camera.cx, camera.cy) for camera in cameras])
    return np.asarray(sigma * (pixels - principal)[:, :, None])
