"""What locating asks of the compute process, without pause: follow a place in pictures, and estimate."""

import itertools
from collections.abc import Callable, Sequence
from math import cos, sin

import numpy as np

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS
from tapreach.robot.config import RobotDescription
from tapreach.tasks.estimating import estimate
from tapreach.tasks.following import close_track, follow, open_track
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target_watch import Shot
from tapreach.tasks.task import Compute

POINT_IN_WORLD = (1.2, 0.15, 0.1)
VIEWS = 24
FRAMES = 60
"""Pictures through which one place is followed."""
_KEY = 1_000_000


async def keep_estimating(
    compute: Compute,
    description: RobotDescription,
    jpegs: Sequence[bytes],
    seed: int,
    on_estimate: Callable[[], None],
) -> None:
    """Call the functions of locating one after the other until cancelled; tell of every estimate."""
    seen = sightings(description, seed)
    size = description.camera.model().size
    while True:
        middle = Pixel(0.5 * size.width, 0.5 * size.height)
        await compute.call(open_track, _KEY, _shot(0, jpegs[0]), middle, description)
        for index, jpeg in enumerate(itertools.islice(itertools.cycle(jpegs), 1, FRAMES), start=1):
            await compute.call(follow, _KEY, _shot(index, jpeg))
            await compute.call(estimate, seen, description, True)
            on_estimate()
        await compute.call(close_track, _KEY)


def _shot(index: int, jpeg: bytes) -> Shot:
    """Return a frame of a robot that drives ahead by a centimetre a frame, for the background to be asked."""
    return Shot(index, index * 33 * MS, jpeg, PlanarPose(0.01 * index), 0.0)


def sightings(description: RobotDescription, seed: int) -> list[Sighting]:
    """Return VIEWS sightings of POINT_IN_WORLD from a drive past it, with a third of a pixel of noise."""
    noise = np.random.default_rng(seed)
    camera = description.camera.model()
    found = []
    for index in range(VIEWS):
        share = index / (VIEWS - 1)
        pose = PlanarPose(0.3 * share * cos(0.3), 0.3 * share * sin(0.3), 0.3 * share)
        world_from_camera = pose.to_rigid() * description.camera.mount.base_from_camera()
        point_in_camera = world_from_camera.inv().apply(np.array(POINT_IN_WORLD))
        ((u, v),) = camera.project([point_in_camera]).pixels
        pixel = Pixel(u + noise.normal(0, 0.3), v + noise.normal(0, 0.3))
        found.append(Sighting(index + 1, index * 100 * MS, pixel, 0.4, 1.0, pose))
    return found
