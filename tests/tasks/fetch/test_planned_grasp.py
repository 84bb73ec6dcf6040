"""Stands as they are planned, in the simulated world: from there the arm lifts what it is planned for.

The base stands where the plan puts it; that it gets there is not tested here.
"""

import math
from dataclasses import dataclass

import pytest

from tapreach.drivers.sim.scene import Scene
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_path import path_to, straight_path
from tapreach.tasks.fetch.arm_workspace import ArmWorkspace
from tapreach.tasks.fetch.grip_motion import LIFT_SPEED, closed, lift_path
from tapreach.tasks.fetch.stand import Stance, stances
from tapreach.tasks.task import TaskContext
from tasks.fetch.test_grasp_in_physics import HALL, THINGS, found, lifts_and_holds, play
from tasks.fetch.worlds import BODY, size_at


@dataclass
class PlannedGrasp:
    """From the stowed arm to what is lifted, by the tips that the stance says."""

    stance: Stance
    width: float
    kind: str = "planned grasp"
    phase: str = ""

    async def run(self, context: TaskContext) -> str:
        arm, pilot = ArmWorkspace.of(context.description), context.pilot
        before, tip = self.stance.tips(BODY.claw)
        waiting = arm.pose_at(before, self.stance.grip.opening)
        assert isinstance(waiting, ArmPose), waiting
        brought = found(path_to(context.description.arm.stowed.pose(), waiting, arm))
        await pilot.follow_arm(brought.timed(arm, 0.3))
        out = found(straight_path(waiting, tip, arm))
        await pilot.follow_arm(out.timed(arm))
        grip = closed(out.end, self.width)
        await pilot.move_arm(grip)
        await pilot.follow_arm(found(lift_path(grip, arm)).timed(arm, LIFT_SPEED))
        return "lifted"


def scene_with(name: str, place: tuple[float, float], yaw_deg: float) -> Scene:
    objects = [{**THINGS[name], "name": "thing", "position": place, "yaw_deg": yaw_deg}]
    return Scene.model_validate({"title": "Hall", "room": HALL.model_dump(), "objects": objects})


@pytest.mark.parametrize(
    ("name", "is_turned"), [("box", False), ("bottle", True), ("ball", False), ("can", True)]
)
def test_thing_before_a_planned_stand_is_lifted_and_held(name: str, is_turned: bool) -> None:
    thing = scene_with(name, (1.0, 0.0), 0.0).objects[0]
    ways = stances(size_at(0.0, 0.0, width=thing.width, height=thing.tall), BODY.claw, BODY.sight)
    stance = next(each for each in ways if (each.rotation != 0.0) == is_turned)
    x, y = (float(each) for each in stance.thing_in_base)
    scene = scene_with(name, (x, y), math.degrees(stance.rotation) + 8.0)
    play(scene, lambda rig: lifts_and_holds(rig, PlannedGrasp(stance, thing.width)))
