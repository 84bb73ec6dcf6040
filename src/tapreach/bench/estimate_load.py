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
        await compute.call(open_track, _KEY, jpegs[0], 0.5 * size.width, 0.5 * size.height)
        for jpeg in itertools.islice(itertools.cycle(jpegs), 1, FRAMES):
            await compute.call(follow, _KEY, jpeg)
            await compute.call(estimate, seen, description, True)
            on_estimate()
        await compute.call(close_track, _KEY)


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
