"""The robot finds out how late its camera's pictures are: it turns a little to and fro, and watches.

Wheels and pictures show the same turn, the pictures later. See estimation/camera_delay.
"""

from dataclasses import dataclass
from math import radians

import numpy as np

from tapreach.estimation.camera_delay import (
    CameraDelay,
    NoDelay,
    TurnRecord,
    estimate_camera_delay,
)
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.config import RobotDescription
from tapreach.tasks.task import TaskContext, TaskReport
from tapreach.vision.followed_places import followed_places
from tapreach.vision.image_io import Gray, decode_gray

WORTH_MEASURING_MS = 2.0
"""Locating measures the delay by itself where the robot file's camera.timing_sigma_ms is so large."""
TURN = radians(6.0)
"""To either side [rad]."""
_BEFORE_NS, _AFTER_NS = 400 * MS, 250 * MS
"""How long the wheels must be known before it begins, and pictures be waited for after it."""
_MOST_PICTURES = 90


@dataclass(frozen=True, eq=False)
class TurnFilm:
    """Stamps [ns] and JPEGs of the pictures, and the base's poses by the wheels with their times [ns]."""

    pictures: tuple[tuple[int, bytes], ...]
    poses: tuple[tuple[int, PlanarPose], ...]


async def measured_delay(context: TaskContext) -> CameraDelay | NoDelay:
    """Turn 6° left, 12° right and back, and return how late the pictures are; takes about 3 s.

    The base ends about where it stood. Raises MotionInterrupted when it is stopped, LinkLost when the camera
    falls silent.
    """
    first = await context.next_frame(0)
    began_ns, start = context.poses.newest()
    for heading in (start.heading + TURN, start.heading - TURN, start.heading):
        here = context.poses.newest()[1]
        await context.pilot.move(PlanarStep(heading - here.heading, 0.0))
    await context.clock.sleep_until(context.clock.now_ns() + _AFTER_NS)
    frames = context.frames.since(first.frame_id - 1)
    some = frames[:: 1 + len(frames) // _MOST_PICTURES]
    pictures = tuple((frame.captured_ns, frame.jpeg) for frame in some)
    film = TurnFilm(pictures, tuple(context.poses.since(began_ns - _BEFORE_NS)))
    return await context.compute.call(delay_in, film, context.description)


async def know_delay(context: TaskContext) -> None:
    """Measure the delay and keep it, unless it is known; say what came of it. Raises as `measured_delay`.

    Where it cannot be told, pictures go on to be taken at their word.
    """
    kept = context.camera_delay
    if kept.known is not None:
        return
    context.report(TaskReport("camera", 0.0, "turning a little to see how late the camera is"))
    found = await measured_delay(context)
    if isinstance(found, CameraDelay):
        kept.known = found
    context.report(TaskReport("camera", 0.0, in_words(found)))


def is_worth_measuring(context: TaskContext) -> bool:
    """Tell whether the robot file leaves the times of pictures so open that locating would suffer."""
    return context.description.camera.timing_sigma_ms >= WORTH_MEASURING_MS


def in_words(found: CameraDelay | NoDelay) -> str:
    """Return what was found, for people."""
    if isinstance(found, NoDelay):
        return f"how late the camera is cannot be told: {found.reason}"
    late_ms, sigma_ms = 1000.0 * found.delay, 1000.0 * found.sigma
    side = "late" if late_ms >= 0.0 else "early"
    return f"the camera is {abs(late_ms):.0f} ms {side} (give or take {2.0 * sigma_ms:.1f} ms)"


def delay_in(film: TurnFilm, description: RobotDescription) -> CameraDelay | NoDelay:
    """Return what a film of a turn to and fro says of the delay."""
    decoded = [(stamp_ns, decode_gray(jpeg)) for stamp_ns, jpeg in film.pictures]
    whole = [(stamp_ns, picture) for stamp_ns, picture in decoded if isinstance(picture, np.ndarray)]
    whole = [each for each in whole if each[1].shape == whole[0][1].shape]
    if not whole or len(film.poses) < 2:
        return NoDelay("there are no pictures of it" if not whole else "the wheels said nothing")
    origin_ns = film.poses[0][0]
    times = np.array([(stamp_ns - origin_ns) / SECOND for stamp_ns, _ in whole])
    azimuths = _azimuths([picture for _, picture in whole], description)
    heading_times = np.array([(at_ns - origin_ns) / SECOND for at_ns, _ in film.poses])
    headings = np.array([pose.heading for _, pose in film.poses])
    return estimate_camera_delay(TurnRecord(times, azimuths, heading_times, headings))


def _azimuths(pictures: list[Gray], description: RobotDescription) -> FloatArray:
    """Return at which azimuth (pictures, places) [rad, left positive] of the base places are seen."""
    pixels = followed_places(pictures).pixels
    in_camera = description.camera.model().unproject(pixels.reshape(-1, 2))
    mount = description.camera.mount.base_from_camera().rotation.as_matrix()
    ahead, left, _ = mount @ in_camera.T
    return np.asarray(np.arctan2(left, ahead).reshape(pixels.shape[:2]))
