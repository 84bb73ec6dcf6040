"""Sizes of things in the rendered simulator, from a few pictures on the way to them."""

import asyncio
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import WorldTruth, ask_truth
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, ManualClock
from tapreach.robot.messages import Frame
from tapreach.tasks.fetch.size import thing_size
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tapreach.tasks.sighting import Sighting
from tasks.rig import sim_description

DESCRIPTION = sim_description()
WAY = ((0.0, 0.0, -0.1), (0.07, -0.02, -0.05), (0.14, -0.05, 0.04), (0.2, -0.07, 0.08), (0.26, -0.06, 0.1))
COVARIANCE = np.diag([2.5e-5, 4e-6, 4e-6])


@lru_cache(maxsize=2)
def film(scene: str) -> tuple[list[tuple[Frame, WorldTruth]], InlineSimRobot]:
    """Return the pictures along the way, with the truth at each; the robot still tells what it saw last."""

    async def taken() -> tuple[list[tuple[Frame, WorldTruth]], InlineSimRobot]:
        clock = ManualClock()
        robot = InlineSimRobot(DESCRIPTION, load_scene(scene), clock, seed=3, shadows=False)
        frames: list[Frame] = []
        robot.frames.subscribe(frames.append)
        await robot.connect()
        shots = []
        for x, y, heading in WAY:
            robot.place_base(PlanarPose(x, y, heading))
            await clock.advance(round(0.22 * SECOND))
            shots.append((frames[-1], await ask_truth(robot, frames[-1].captured_ns)))
        await robot.close()
        return shots, robot

    return asyncio.run(taken())


def followed(shots: list[tuple[Frame, WorldTruth]], point: FloatArray) -> list[Sighting]:
    """Return what a perfect tracker would see of a point, poses by the truth."""
    camera = DESCRIPTION.camera.model()
    sightings = []
    for frame, truth in shots:
        u, v = camera.project(truth.camera_pose.inv().apply(point[None])).pixels[0]
        pixel = Pixel(float(u), float(v))
        sightings.append(Sighting(frame.frame_id, frame.captured_ns, pixel, 0.3, 1.0, truth.base_pose))
    return sightings


def on_front(name: str, shots: list[tuple[Frame, WorldTruth]], robot: InlineSimRobot) -> FloatArray:
    """Return a place on what the last picture shows of a thing."""
    truth = shots[-1][1]
    centre = np.array(truth.object(name).centre_in_world)
    way = truth.camera_pose.inv().apply(centre)
    surface = robot.surfaces_seen(way[None] / np.linalg.norm(way), shots[-1][0].captured_ns)[0]
    assert surface is not None and surface.name == name
    return surface.point_in_world


def sized(point: FloatArray, shots: list[tuple[Frame, WorldTruth]]) -> ThingSize | NoSize:
    jpegs = {frame.frame_id: frame.jpeg for frame, _ in shots}
    return thing_size(point, COVARIANCE, 0.012, followed(shots, point), jpegs, DESCRIPTION)


@pytest.mark.parametrize("name", ["red can", "tea", "juice"])
def test_thing_on_the_floor_is_as_large_and_where_it_is(name: str) -> None:
    shots, robot = film("room")
    point = on_front(name, shots, robot)
    size = sized(point, shots)
    assert isinstance(size, ThingSize), size
    thing, way = shots[-1][1].object(name), point - shots[-1][1].camera_pose.translation
    left = np.array([-way[1], way[0], 0.0]) / np.hypot(way[0], way[1])
    axes = np.abs(left @ np.array(thing.world_from_object)[:3, :2])
    width = thing.size[0] if thing.kind != "box" else float(axes @ thing.size[:2])
    assert size.width == pytest.approx(width, abs=0.008)
    assert size.height == pytest.approx(thing.size[2], abs=0.02)
    assert size.foot == 0.0 and size.caveat == "by the picture"
    assert abs((size.axis_in_world - np.array(thing.centre_in_world)) @ left) < 0.006
    assert np.linalg.norm(size.axis_in_world[:2] - thing.centre_in_world[:2]) < 0.02
    assert 0.001 < size.width_sd < 0.02 and np.linalg.eigvalsh(size.axis_cov_in_world)[0] > 0.0


def test_part_of_something_larger_is_never_told_as_a_small_thing() -> None:
    shots, robot = film("room")
    reasons = []
    for across, down in ((-0.1, -0.2), (0.1, -0.3), (0.3, -0.2), (0.3, -0.4)):
        away = np.array([[across, down, 1.0]])
        surface = robot.surfaces_seen(away / np.linalg.norm(away), shots[-1][0].captured_ns)[0]
        assert surface is not None and surface.name == ""
        size = sized(surface.point_in_world, shots)
        assert isinstance(size, NoSize) or size.width > 0.15
        reasons += [size.reason] if isinstance(size, NoSize) else []
    assert any("flat on what is behind it" in reason for reason in reasons)


def test_too_few_pictures_are_a_reason() -> None:
    shots, robot = film("room")
    size = sized(on_front("tea", shots, robot), shots[:2])
    assert isinstance(size, NoSize) and "2 pictures" in size.reason


def test_broken_pictures_are_a_reason() -> None:
    shots, robot = film("room")
    broken = [(replace(frame, jpeg=frame.jpeg[:100]), truth) for frame, truth in shots]
    assert isinstance(sized(on_front("tea", shots, robot), broken), NoSize)


def test_size_does_not_depend_on_where_the_world_begins() -> None:
    shots, robot = film("room")
    point = on_front("red can", shots, robot)
    jpegs = {frame.frame_id: frame.jpeg for frame, _ in shots}
    elsewhere = PlanarPose(-3.0, 7.0, 2.0)
    moved = elsewhere.to_rigid()
    sightings = [
        replace(each, world_from_base=elsewhere.compose(each.world_from_base))
        for each in followed(shots, point)
    ]
    turn = moved.rotation.as_matrix()
    there = thing_size(moved.apply(point), turn @ COVARIANCE @ turn.T, 0.012, sightings, jpegs, DESCRIPTION)
    here = sized(point, shots)
    assert isinstance(there, ThingSize) and isinstance(here, ThingSize)
    assert there.width == pytest.approx(here.width, abs=0.004)
    assert np.linalg.norm(RigidTransform.apply(moved, here.axis_in_world) - there.axis_in_world) < 0.005
