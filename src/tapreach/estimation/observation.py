"""One sighting of the target: a pixel, the camera that saw it, and where that camera was."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray, positive
from tapreach.geometry.pixel import Pixel, require_inside


@dataclass(frozen=True)
class Observation:
    """The target was seen at `pixel`, one sigma `pixel_sigma` [px] in u and in v, by `camera`.

    world_from_base: where the base was, by odometry or otherwise. base_from_camera: the mount; identity
    where the poses given are those of the camera. Raises InputError for a pixel outside the picture and a
    sigma that is not above zero.
    """

    pixel: Pixel
    pixel_sigma: float
    camera: Camera
    world_from_base: RigidTransform
    base_from_camera: RigidTransform
    base_matrix: FloatArray = field(init=False, repr=False, compare=False)
    """world_from_base as (4, 4): with every new view, all that came before are asked for it again."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "pixel_sigma", positive("pixel_sigma", self.pixel_sigma))
        require_inside(self.pixel, self.camera.size)
        for name in ("world_from_base", "base_from_camera"):
            if not isinstance(getattr(self, name), RigidTransform):
                raise InputError(f"{name} is a {type(getattr(self, name)).__name__}; give a RigidTransform")
        object.__setattr__(self, "base_matrix", self.world_from_base.as_matrix())

    @property
    def mount_matrix(self) -> FloatArray:
        """base_from_camera as (4, 4)."""
        return matrix_of_mount(self.base_from_camera)

    @property
    def world_from_camera(self) -> RigidTransform:
        """Pose of the camera in the world."""
        return self.world_from_base * self.base_from_camera


@lru_cache(maxsize=16)
def matrix_of_mount(base_from_camera: RigidTransform) -> FloatArray:
    """Return a mount as (4, 4), read-only; a robot has one or few, and the same objects all the time."""
    matrix = np.asarray(base_from_camera.as_matrix(), dtype=np.float64)
    matrix.flags.writeable = False
    return matrix
