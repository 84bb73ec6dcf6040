"""One sighting of a target by the robot: what the tracker said of a frame, and where the base was then."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.estimation.observation import Observation
from tapreach.estimation.step_knowledge import StepKnowledge
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, wrapped
from tapreach.geometry.ray import Ray
from tapreach.robot.config import CameraSection, RobotDescription
from tapreach.tasks.optics import optics_of

NEAREST = 0.5
"""Distance [m] at which an advance moves the picture as much as is reckoned with."""
TAP_SIGMA = 0.3
"""The tapped pixel itself: what is followed is the patch around it, rounded by the camera's own sampling
[px].
"""


@dataclass(frozen=True, slots=True)
class SeenWay:
    """What the background says of the base's way from frame `since_id` on, and of the camera's mount.

    reason: why it says nothing; '' where it does. stands_still: the wheels have turned since it was last
    asked, and the picture has not moved.
    """

    since_id: int
    knowledge: StepKnowledge
    reason: str = ""
    stands_still: bool = False


@dataclass(frozen=True, slots=True)
class Sighting:
    """The target in one frame. sigma: one standard deviation of u and of v [px], motion included.

    world_from_base: by the wheels. way: what the background says of it, None where it was not asked.
    is_key: later ways are counted from this frame.
    """

    frame_id: int
    captured_ns: int
    pixel: Pixel
    sigma: float
    scale: float
    world_from_base: PlanarPose
    way: SeenWay | None = None
    is_key: bool = False


@dataclass(frozen=True, slots=True)
class Passed:
    """A frame in which the target is not seen, but the way to it; fields as those of a sighting."""

    frame_id: int
    world_from_base: PlanarPose
    way: SeenWay
    is_key: bool


def observation_of(
    sighting: Sighting, description: RobotDescription, base_from_camera: RigidTransform | None = None
) -> Observation:
    """Return it as the estimator wants it; base_from_camera: where known better than by the robot's file."""
    lens, mount, _ = optics_of(description.camera)
    return Observation(
        sighting.pixel,
        sighting.sigma,
        lens,
        sighting.world_from_base.to_rigid(),
        mount if base_from_camera is None else base_from_camera,
    )


def ray_of(sighting: Sighting, description: RobotDescription) -> Ray:
    """Return the line of sight in the world."""
    return rays_of([sighting], description)[0]


def rays_of(sightings: Sequence[Sighting], description: RobotDescription) -> tuple[Ray, ...]:
    """Return the lines of sight in the world, in the order of the sightings."""
    if not sightings:
        return ()
    camera, _, base_from_camera = optics_of(description.camera)
    poses = [sighting.world_from_base for sighting in sightings]
    pixels = np.array([(sighting.pixel.u, sighting.pixel.v) for sighting in sightings])
    directions = _turned(camera.unproject(pixels) @ base_from_camera[:3, :3].T, poses)
    origins = _turned(np.tile(base_from_camera[:3, 3], (len(poses), 1)), poses)
    origins[:, :2] += [(pose.x, pose.y) for pose in poses]
    return tuple(map(Ray, origins, directions))


def _turned(vectors: FloatArray, poses: Sequence[PlanarPose]) -> FloatArray:
    """Return vectors (n, 3), one for each base pose, with the axes of the world."""
    c, s = np.array([(math.cos(pose.heading), math.sin(pose.heading)) for pose in poses]).T
    x, y, z = vectors.T
    return np.stack([c * x - s * y, s * x + c * y, z], axis=1)


def sigma_of_timing(step: PlanarPose, duration: float, camera: CameraSection, timing_sigma: float) -> float:
    """Return one sigma [px] that motion adds: the picture's speed times the uncertainty of the frame's time.

    step: how the base moved in the `duration` [s] before the frame. timing_sigma [s]: of that time.
    """
    turned, advanced = abs(wrapped(step.heading)), math.hypot(step.x, step.y)
    return camera.fx * (turned + advanced / NEAREST) / duration * timing_sigma


def is_apart(first: PlanarPose, second: PlanarPose, distance: float, angle: float) -> bool:
    """Tell whether two poses of the base differ by more than `distance` [m] or `angle` [rad]."""
    is_elsewhere = math.hypot(second.x - first.x, second.y - first.y) > distance
    return is_elsewhere or abs(wrapped(second.heading - first.heading)) > angle
