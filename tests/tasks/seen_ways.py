"""What the background says of a way, from points of a room without a picture."""

import numpy as np

from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.rotation_from_background import rotation_from_background
from tapreach.geometry.camera import Projection
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import SeenWay
from tasks.rig import sim_description

ROBOT = sim_description()
CAMERA, MOUNT = ROBOT.camera.model(), ROBOT.camera.mount.base_from_camera()
SaidAndTrue = tuple[PlanarPose, PlanarPose]


def pixels_of(points: FloatArray, pose: PlanarPose) -> Projection:
    return CAMERA.project((pose.to_rigid() * MOUNT).inv().apply(points))


def seen_way(first: SaidAndTrue, second: SaidAndTrue, since_id: int) -> SeenWay:
    """Return what is seen of the way between two poses of the base, each by the wheels and in truth."""
    rng = np.random.default_rng(2)
    points = rng.uniform([0.6, -1.5, 0.0], [4.0, 2.5, 1.5], (900, 3))
    before, now = pixels_of(points, first[1]), pixels_of(points, second[1])
    both = before.is_inside & now.is_inside
    step = camera_step(first[0].between(second[0]), odometry_noise(ROBOT), MOUNT, mount_noise(ROBOT))
    found = rotation_from_background(
        before.pixels[both] + 0.2 * rng.normal(size=(both.sum(), 2)), now.pixels[both], CAMERA, step
    )
    return SeenWay(since_id, found.knowledge)
