"""A robot's camera as the tasks need it many times a frame: lens and mount, and points as they are seen."""

import math
from functools import lru_cache

from scipy.spatial.transform import RigidTransform

from tapreach.geometry.camera import Camera
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import pose_to_matrix
from tapreach.robot.config import CameraSection


@lru_cache(maxsize=4)
def optics_of(camera: CameraSection) -> tuple[Camera, RigidTransform, FloatArray]:
    """Return lens and base_from_camera, also as (4, 4); made once, as they are always the same."""
    mount = camera.mount.base_from_camera()
    return camera.model(), mount, pose_to_matrix(mount)


def points_in_camera(
    points_in_world: FloatArray, world_from_base: PlanarPose, camera: CameraSection
) -> FloatArray:
    """Return points (n, 3) [m] in the frame of the camera of a base that stands at `world_from_base`."""
    base_from_camera = optics_of(camera)[2]
    c, s = math.cos(world_from_base.heading), math.sin(world_from_base.heading)
    x, y = points_in_world[:, 0] - world_from_base.x, points_in_world[:, 1] - world_from_base.y
    in_base = points_in_world.copy()
    in_base[:, 0], in_base[:, 1] = c * x + s * y, c * y - s * x
    return (in_base - base_from_camera[:3, 3]) @ base_from_camera[:3, :3]
