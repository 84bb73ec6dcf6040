"""A camera on a base that drives, and a target seen from it: what the estimation tests have in common."""

import math

from tapreach.estimation.observation import Observation
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount

CAMERA = Camera(ImageSize(640, 480), 600.0, 600.0, 319.5, 239.5)
MOUNT = camera_mount((0.10, 0.01, 0.15), math.radians(10.0), 0.02, -0.01)
CENTRED_MOUNT = camera_mount((0.0, 0.0, 0.15))
TWELVE_AND_TWENTY = [PlanarStep(math.radians(12.0), 0.2)]


def poses_along(steps):
    poses = [PlanarPose()]
    for step in steps:
        poses.append(poses[-1].after(step))
    return poses


def observed(poses, target, mount=MOUNT, camera=CAMERA, sigma=1.0, said=None, rng=None):
    """Return what a base at `poses` sees of `target`, filed under the poses it `said` it had."""
    observations = []
    for pose, told in zip(poses, said or poses, strict=True):
        camera_from_world = (pose.to_rigid() * mount).inv()
        pixel = camera.project(camera_from_world.apply(target)[None]).pixels[0]
        if rng is not None:
            pixel = pixel + sigma * rng.normal(size=2)
        observations.append(
            Observation(Pixel(float(pixel[0]), float(pixel[1])), sigma, camera, told.to_rigid(), mount)
        )
    return observations
