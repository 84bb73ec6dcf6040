"""Looking for the thing again: after a miss, after a stop, or from nearer; with what the earlier look told.

Where it should be by the way since is only a start: it may have been pushed. It is found there by how it
looked in the last picture that showed it.
"""

import math
from contextlib import suppress
from dataclasses import replace

import numpy as np

from tapreach.errors import FrameError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import Frame
from tapreach.tasks.estimating import LocatedPoint
from tapreach.tasks.fetch.arm_leading import ArmBlocked, fold
from tapreach.tasks.fetch.by_colours import is_of_its_colours, tap_by_colours
from tapreach.tasks.fetch.expected_box import AT_REST_PX, pixel_by_point
from tapreach.tasks.fetch.known_target import pixel_of
from tapreach.tasks.fetch.known_thing import Appearance, KnownThing
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.thing import ThingSize
from tapreach.tasks.follower import LATEST_NS
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.locating import Locating
from tapreach.tasks.optics import optics_of
from tapreach.tasks.sighting import is_apart
from tapreach.tasks.task import Tap, TaskContext
from tapreach.vision.image_io import BrokenPicture, decode_gray
from tapreach.vision.seen_again import Expected, SeenAgain, seen_again

_ELSEWHERE = 0.08, math.radians(8.0)
"""A sight of it from farther away than this [m, rad] is none from here."""
_SAME_SIGMAS = 4.0
"""What is located farther from where it was known to be is another thing."""
_SPOT_SHARE = 0.5
"""Another spot of the thing is off by this share of half its size, one sigma."""
_LEAST_STEP, _MOST_STEP = 0.06, 0.2
_SURELY_MET = 0.6
"""A tap unseen may miss the middle by this share of half the thing's width, one sigma."""


def keep_what_is_known(run: FetchRun) -> None:
    """Remember place, size and looks of the thing as they are known by now; what they were, before that."""
    estimate = run.locating.estimate if run.locating is not None else None
    if estimate is None or estimate.point_in_world is None:
        return
    thing, here = run.thing(), run.here
    size = run.sized_along(thing.size) if isinstance(thing.size, ThingSize) else None
    before = run.memory.known
    seen = _appearance(run, estimate) or (before.appearance if before is not None else None)
    place = KnownPlace(thing.point_in_world, thing.point_cov_in_world, here)
    colours = before.colours if before is not None else None
    run.remember(known=KnownThing(place, size, run.axis_offset, seen, colours))


async def locate_again(run: FetchRun, locating: Locating) -> str:
    """Locate with what the looks before have told, and return the closing sentence. Raises as LocateTask.run.

    A thing that could not be measured is looked at from as many places as if nothing had been known.
    """
    known = run.memory.known
    if known is not None and known.size is not None:
        await locating.recall(known.place_seen_from(run.here))
    sentence = await locating.run()
    if known is not None and known.size is None:
        await locating.recall(known.place_seen_from(run.here))
    return sentence


def still_followed(run: FetchRun) -> Tap | None:
    """Return a tap on the place that is being followed; None where nothing is, or it is not seen."""
    if loss_of(run) or run.locating is None:
        return None
    last = run.locating.follower.last
    return Tap(last.frame_id, last.pixel.u, last.pixel.v)


def loss_of(run: FetchRun) -> str:
    """Return why the thing is not seen from here, '' where it is: also where it was followed to here, but
    that was not confirmed as what was tapped.
    """
    follower = run.locating.follower if run.locating is not None else None
    if follower is None or not follower.sightings:
        return "nothing follows it"
    if follower.loss or not is_apart(follower.last.world_from_base, run.here, *_ELSEWHERE):
        return follower.loss
    return "what was followed here is not surely what was tapped"


async def tap_again(run: FetchRun) -> Tap | None:
    """Return a tap on the thing where it is seen in a new picture, by its own colours or else by how it
    looked; None where it is not. Raises LinkLost when the camera is silent.
    """
    if run.memory.known is None:
        return None
    await _out_of_the_picture(run)
    frame = await frame_from_now_on(run.context)
    here = await pose_at(run.context, frame.captured_ns)
    return await tap_by_colours(run, frame, here) or await _tap_by_looks(run, run.memory.known, frame, here)


async def _tap_by_looks(run: FetchRun, known: KnownThing, frame: Frame, here: PlanarPose) -> Tap | None:
    """Return a tap where a picture taken at `here` shows it as it looked before, if it has its colours; what
    has left the picture with the tapped spot is not seen.
    """
    context, seen = run.context, known.appearance
    there = expected(known, here, context.description) if seen is not None else None
    if seen is None or there is None:
        return None
    found = await context.compute.call(
        _find, seen, _half_px(known, seen, context.description), frame.jpeg, there
    )
    if found is None:
        return None
    pixel = Pixel(*map(float, found.pixel))
    if not pixel.is_inside(frame.size) or not await is_of_its_colours(run, frame, pixel, here):
        return None
    return Tap(frame.frame_id, pixel.u, pixel.v)


async def frame_from_now_on(context: TaskContext) -> Frame:
    """Return the first picture taken from now on, or what comes after a second of waiting for it."""
    now_ns, newest = context.clock.now_ns(), context.frames.newest
    while True:
        newest = await context.next_frame(newest.frame_id if newest is not None else 0)
        is_late = context.clock.now_ns() - now_ns > LATEST_NS
        if is_late or context.camera_delay.taken_ns(newest.captured_ns) >= now_ns:
            return newest


async def tap_unseen(run: FetchRun) -> Tap | None:
    """Return a tap in the newest picture on where the thing's front should be, for one that looks otherwise
    from here; None where it is not known well enough to be surely met, is out of the picture, or where the
    picture shows other colours.

    From then on that front is the spot that is known.
    """
    known, frame = run.memory.known, run.context.frames.newest
    if known is None or known.size is None or known.axis_offset is None or frame is None:
        return None
    place = known.place.seen_from(run.here, run.context.description)
    half = known.size.width / 2.0
    ahead, across = _along_and_across(run.here, known.middle)
    front = known.middle - half * ahead
    pixel = pixel_of(run.context, front)
    if pixel is None or float(across @ place.cov_in_world @ across) > (_SURELY_MET * half) ** 2:
        return None
    if not await is_of_its_colours(run, frame, pixel, run.here):
        return None
    run.remember(known=replace(known, place=replace(place, point_in_world=front), axis_offset=half * ahead))
    return Tap(frame.frame_id, pixel.u, pixel.v)


def _along_and_across(here: PlanarPose, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return level unit vectors (3,) from the base to a place, and to the left of that."""
    off = place[:2] - [here.x, here.y]
    x, y = off / max(float(np.hypot(*off)), 1e-9)
    return np.array([x, y, 0.0]), np.array([-y, x, 0.0])


async def _out_of_the_picture(run: FetchRun) -> None:
    """Fold the arm, which a stop may have left before the camera; what is still seen past it may do."""
    with suppress(ArmBlocked):
        await fold(run)


def is_where_it_was(run: FetchRun) -> bool:
    """Tell whether the thing just located can be the one known before, be it by another spot of it."""
    known, found = run.memory.known, run.thing()
    if known is None:
        return True
    there = known.place.seen_from(run.here, run.context.description)
    off = found.point_in_world - there.point_in_world
    half_width, half_height = _SPOT_SHARE * known.half_size
    on_thing = np.diag(np.square([half_width, half_width, half_height]))
    off_sigmas = off @ np.linalg.solve(found.point_cov_in_world + there.cov_in_world + on_thing, off)
    return bool(off_sigmas <= _SAME_SIGMAS**2)


def expected(known: KnownThing, here: PlanarPose, description: RobotDescription) -> Expected | None:
    """Return where the thing should be in a picture taken at `here`; None where it would not be in it."""
    assert known.appearance is not None
    place = known.place.seen_from(here, description)
    camera, mount, _ = optics_of(description.camera)
    camera_from_world = (here.to_rigid() * mount).inv()
    point = camera_from_world.apply(place.point_in_world)
    projection = camera.project(point[None])
    if not projection.is_valid[0] or not projection.is_inside[0]:
        return None
    by_point = pixel_by_point(place.point_in_world, here, description)
    distance = float(np.linalg.norm(point))
    nearer = known.appearance.distance / distance
    moved = camera.fx * math.radians(description.camera.mount.angle_sigma_deg) * abs(nearer - 1.0)
    at_rest = (AT_REST_PX**2 + moved**2) * np.eye(2)
    covariance = by_point @ place.cov_in_world @ by_point.T + at_rest
    distance_sd = math.sqrt(float(np.linalg.eigvalsh(place.cov_in_world)[-1]))
    return Expected(projection.pixels[0], covariance, _scales(nearer, distance_sd / distance))


def _scales(likeliest: float, relative_sd: float) -> tuple[float, ...]:
    step = 1.0 + min(max(relative_sd, _LEAST_STEP), _MOST_STEP)
    return tuple(likeliest * step**power for power in (0, -1, 1, -2, 2))


def _half_px(known: KnownThing, seen: Appearance, description: RobotDescription) -> float:
    return description.camera.fx * float(known.half_size.max()) / seen.distance


def _find(seen: Appearance, half_px: float, jpeg: bytes, there: Expected) -> SeenAgain | None:
    earlier, picture = decode_gray(seen.jpeg), decode_gray(jpeg)
    if isinstance(earlier, BrokenPicture) or isinstance(picture, BrokenPicture):
        return None
    return seen_again(earlier, (seen.pixel.u, seen.pixel.v), half_px, picture, there)


def _appearance(run: FetchRun, estimate: LocatedPoint) -> Appearance | None:
    """Return the newest picture that shows it and is still kept."""
    point, description = estimate.point_in_world, run.context.description
    fitting = [each for i, each in enumerate(estimate.sightings) if i not in estimate.rejected_views]
    if point is None:
        return None
    for sighting in reversed(fitting):
        try:
            jpeg = run.context.frames.get(sighting.frame_id).jpeg
        except FrameError:
            continue
        camera = (sighting.world_from_base.to_rigid() * optics_of(description.camera)[1]).translation
        return Appearance(jpeg, sighting.pixel, float(np.linalg.norm(point - camera)))
    return None
