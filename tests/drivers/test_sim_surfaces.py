"""What the camera truly sees in a direction, and a robot lifted to another place."""

import asyncio

import numpy as np
import pytest
from sim_world import ROBOT

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, ManualClock


def in_room(test):
    async def run():
        clock = ManualClock()
        robot = InlineSimRobot(ROBOT, load_scene("room"), clock, has_pictures=False)
        await robot.connect()
        try:
            await clock.advance(SECOND // 10)
            await test(robot, clock)
        finally:
            await robot.close()

    asyncio.run(run())


def test_line_of_sight_to_the_middle_of_a_thing_ends_on_its_surface():
    async def test(robot, clock):
        truth = await ask_truth(robot)
        can = truth.object("red can")
        direction = truth.camera_pose.inv().apply(np.array(can.centre_in_world))
        (surface,) = robot.surfaces_seen(direction[None] / np.linalg.norm(direction))
        assert surface.name == "red can"
        radius, height = can.size[0] / 2, can.size[2]
        assert np.hypot(*surface.point_in_object[:2]) == pytest.approx(radius, abs=2e-3)
        assert abs(surface.point_in_object[2]) <= height / 2 + 1e-3
        assert surface.distance == pytest.approx(
            np.linalg.norm(surface.point_in_world - truth.camera_pose.translation)
        )

    in_room(test)


def test_floor_belongs_to_no_thing():
    async def test(robot, clock):
        (surface,) = robot.surfaces_seen(np.array([[0.0, 0.6, 0.8]]))
        assert surface.name == ""
        assert surface.point_in_world[2] == pytest.approx(0.0, abs=0.02)

    in_room(test)


def test_robot_lifted_elsewhere_stands_there_and_its_odometry_does_not_notice():
    async def test(robot, clock):
        told = []
        robot.base.subscribe(told.append)
        robot.place_base(PlanarPose(-0.4, 0.5, 2.0))
        await clock.advance(SECOND // 2)
        there = (await ask_truth(robot)).base_pose
        assert (there.x, there.y, there.heading) == pytest.approx((-0.4, 0.5, 2.0), abs=2e-3)
        assert told[-1].world_from_base == PlanarPose()

    in_room(test)
