"""Where a target should be in the next frame, from how the robot moved: guesses for the tracker."""

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.sighting import Sighting, ray_of
from tapreach.vision.track import Guess

DISTANCES = (1.2, 0.2, 0.25, 0.3, 0.37, 0.45, 0.55, 0.7, 0.9, 1.6, 2.2, 3.5, 8.0)
"""Distances [m] tried for a target of which nothing is known, the most likely one first."""


def guesses_for(
    last: Sighting,
    world_from_base: PlanarPose,
    description: RobotDescription,
    distances: Sequence[float] = DISTANCES,
) -> tuple[Guess, ...]:
    """Return where a target last seen in `last` falls in a frame taken at `world_from_base`.

    One guess for each supposed distance [m] along the line of sight of `last`; those that the camera would
    not see are left out.
    """
    ray = ray_of(last, description)
    points_in_world = np.stack([ray.at(distance) for distance in distances])
    camera_from_world = _camera_from_world(world_from_base, description)
    return tuple(_seen(points_in_world, camera_from_world.apply(points_in_world), last, description))


def _camera_from_world(world_from_base: PlanarPose, description: RobotDescription) -> RigidTransform:
    return (world_from_base.to_rigid() * description.camera.mount.base_from_camera()).inv()


def _seen(
    points_in_world: FloatArray, points_in_camera: FloatArray, last: Sighting, description: RobotDescription
) -> Iterable[Guess]:
    projection = description.camera.model().project(points_in_camera)
    depths_before = _camera_from_world(last.world_from_base, description).apply(points_in_world)[:, 2]
    for pixel, is_inside, before, now in zip(
        projection.pixels, projection.is_inside, depths_before, points_in_camera[:, 2], strict=True
    ):
        if is_inside:
            yield Guess(float(pixel[0]), float(pixel[1]), last.scale * float(before / now))
