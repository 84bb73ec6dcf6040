"""A fetch that has followed a thing of some colours, in pictures drawn for the tests."""

import asyncio
from dataclasses import replace

import cv2
import numpy as np

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.messages import Frame
from tapreach.tasks.estimating import estimate
from tapreach.tasks.fetch.by_colours import learn_colours
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.known_thing import KnownThing
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import ROBOT, size_at
from tasks.rig import bare_context

HERE = PlanarPose(0.05, 0.0, 0.0)
MIDDLE = np.array([0.6, 0.03, 0.05])
SPOT = MIDDLE - [0.025, 0.0, 0.0]
"""On the front of a thing 5 cm wide and 10 cm high."""
RED, GREEN = (30, 30, 190), (60, 150, 40)


def pixel_of(point: np.ndarray, here: PlanarPose = HERE) -> np.ndarray:
    in_camera = points_in_camera(point[None], here, ROBOT.camera)
    return np.asarray(optics_of(ROBOT.camera)[0].project(in_camera).pixels[0])


def frame(
    middle: np.ndarray,
    colour: tuple[int, int, int],
    here: PlanarPose = HERE,
    number: int = 0,
    half: tuple[float, float] = (0.025, 0.05),
) -> Frame:
    """A picture from `here` of a grey room with a box of one colour about `middle`."""
    size = optics_of(ROBOT.camera)[0].size
    picture = np.full((size.height, size.width, 3), 120, np.uint8)
    corners = [pixel_of(middle + side * np.array([0.0, *half]), here) for side in (1.0, -1.0)]
    cv2.rectangle(picture, *(tuple(map(int, np.round(each))) for each in corners), colour, -1)
    jpeg = bytes(cv2.imencode(".jpg", picture)[1])
    return Frame(number, number, number, size, jpeg)


class Followed:
    """What a follower that sees the thing is to a fetch."""

    def __init__(self, sightings: list[Sighting], doubt: str = "") -> None:
        self.sightings, self.loss, self.doubt, self.last = sightings, "", doubt, sightings[-1]


class Located:
    """What a locating that has ended is to a fetch."""

    way_since_seen = ()

    def __init__(self, follower: Followed) -> None:
        self.follower, self.estimate = follower, estimate(follower.sightings, ROBOT, False)


def run_after_look(colours: tuple[tuple[int, int, int], ...], doubt: str = "") -> FetchRun:
    """A fetch that has followed a thing, shown with the colours in the views of the look."""
    context = bare_context()
    context.poses.add(1, HERE)
    place = KnownPlace(SPOT, 0.02**2 * np.eye(3), HERE)
    known = KnownThing(place, replace(size_at(0.6, 0.03), seen_along=0.0), MIDDLE - SPOT)
    run = FetchRun(context, FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO, known=known), (), None)  # type: ignore[arg-type]
    views = []
    for i, colour in enumerate(colours):
        pose = HERE.after(PlanarStep(0.0, -0.1 * (len(colours) - 1 - i)))
        context.frames.add(frame(MIDDLE, colour, pose, i))
        views.append(Sighting(i, i, Pixel(*map(float, pixel_of(SPOT, pose))), 0.4, 1.0, pose))
    run.locating = Located(Followed(views, doubt))  # type: ignore[assignment]
    asyncio.run(learn_colours(run))
    return run
