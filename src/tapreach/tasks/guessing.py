"""Where a target should be in the next frame, from how the robot moved: guesses for the tracker."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting, ray_of
from tapreach.vision.track import Guess

DISTANCES = (1.2, 0.2, 0.25, 0.3, 0.37, 0.45, 0.55, 0.7, 0.9, 1.6, 2.2, 3.5, 8.0)
"""Distances [m] tried for a target of which nothing is known, the most likely one first."""

_AT_REST, _OF_MOTION = 3.0, 0.04
"""Uncertainty of a guess, one sigma: of a camera that rocks [px], and the share of how far it moved in the
picture that odometry may be wrong by.
"""
_BEYOND_SIGMAS = 2.0
"""A place expected so little beyond the picture's edge may yet be in it."""


def guesses_for(
    last: Sighting,
    world_from_base: PlanarPose,
    description: RobotDescription,
    distances: Sequence[float] = DISTANCES,
) -> tuple[Guess, ...]:
    """Return where a target last seen in `last` falls in a frame taken at `world_from_base`.

    One guess for each supposed distance [m] along the line of sight of `last`, but for those behind the
    camera; some may lie beyond the picture's edge. No guess at all means that it cannot be in the picture.
    """
    ray = ray_of(last, description)
    points_in_world = np.stack([ray.at(distance) for distance in distances])
    in_camera = points_in_camera(points_in_world, world_from_base, description.camera)
    return tuple(_seen(points_in_world, in_camera, last, description))


def _seen(
    points_in_world: FloatArray, in_camera: FloatArray, last: Sighting, description: RobotDescription
) -> Iterable[Guess]:
    camera = optics_of(description.camera)[0]
    projection = camera.project(in_camera)
    depths_before = points_in_camera(points_in_world, last.world_from_base, description.camera)[:, 2]
    nearer = np.where(projection.is_valid, depths_before / in_camera[:, 2], 1.0)
    sigmas = guess_sigma(last.sigma, projection.pixels - last.pixel.to_array(), nearer, description)
    if not np.any(projection.is_valid & may_be_on(camera.size, projection.pixels, sigmas)):
        return
    for index in np.flatnonzero(projection.is_valid):
        u, v = map(float, projection.pixels[index])
        yield Guess(u, v, last.scale * float(nearer[index]), float(sigmas[index]))


def guess_sigma(
    sigma: float | FloatArray, moved: FloatArray, nearer: FloatArray, description: RobotDescription
) -> FloatArray:
    """Return one sigma [px] (n,) of guesses that lie `moved` (n, 2) [px] from a sighting known to `sigma`.

    nearer: (n,) ratio of the depths before and now; what comes nearer moves away from where the camera is
    driven to, and that is only known as well as the mount's angles.
    """
    way = np.linalg.norm(moved, axis=1)
    mount = 2.0 * math.radians(description.camera.mount.angle_sigma_deg) * description.camera.fx
    parts = (_AT_REST, np.asarray(sigma), _OF_MOTION * way, mount * np.abs(nearer - 1.0))
    return np.asarray(np.sqrt(sum(np.square(part) for part in parts)))


def may_be_on(size: ImageSize, pixels: FloatArray, sigmas: FloatArray) -> NDArray[np.bool_]:
    """Tell for each guess (n, 2) whether the place can be on a picture of `size`, given its sigma (n,)."""
    spare = _BEYOND_SIGMAS * sigmas[:, None]
    inside = (pixels > -spare) & (pixels < np.array([size.width, size.height]) + spare)
    return np.asarray(np.all(inside, axis=1))
