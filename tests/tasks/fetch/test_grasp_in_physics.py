"""The arm's paths in the simulated world: what they grip is lifted and held.

The place of the thing is known here, from the scene; a fetch has to see it.
"""

import asyncio
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Room, Scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.chain_arm import ChainArm
from tapreach.resources import resource_path
from tapreach.robot.clock import ManualClock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_path import ArmPath, path_to, straight_path
from tapreach.tasks.fetch.arm_workspace import ArmWorkspace, Unreachable
from tapreach.tasks.fetch.grip_motion import LIFT_SPEED, closed, lift_path
from tapreach.tasks.runner import TaskState
from tapreach.tasks.task import TaskContext
from tasks.rig import OPERATOR, Rig, running_rig

ROBOT = load_robot(resource_path("robots") / "sim.toml")
HALL = Room(x=(-2.0, 2.0), y=(-2.0, 2.0), skirting=False)
BEFORE = 0.07
"""Way from where the open claw waits to the middle of the thing [m]."""
HOLD_S = 2.0

BOX: Mapping[str, Any] = {"kind": "box", "size": (0.04, 0.04, 0.06)}
THINGS: Mapping[str, Mapping[str, Any]] = {
    "box": BOX,
    "can": {"kind": "can"},
    "bottle": {"kind": "bottle"},
    "cup": {"kind": "cup"},
    "ball": {"kind": "ball"},
}


def chain_instead_of_sizes(description: RobotDescription) -> RobotDescription:
    """The same robot, its arm described by its joints."""
    arm = description.arm.model_dump()
    for name in ("shoulder_forward", "shoulder_up", "upper_length", "fore_length", "hand_length"):
        arm[name] = None
    joints = [
        {"axis": (0, 0, 1), "offset": (0.02, -0.045, 0.121)},
        {"axis": (0, 1, 0), "offset": (0, 0, 0)},
        {"axis": (0, 1, 0), "offset": (0, 0, 0.12)},
    ]
    arm["chain"] = {"joints": joints, "wrist": (0.12, 0, 0), "hand": (0.072, 0, 0)}
    return RobotDescription.model_validate({**description.model_dump(), "arm": arm})


@dataclass
class Grasp:
    """A scripted grasp of a thing of this width and height [m] at `place` in the base frame (2,) [m], taken
    to be `off` (3,) [m] from there: farther, to the left, higher.
    """

    width: float
    height: float
    place: tuple[float, float]
    off: tuple[float, float, float] = (0.0, 0.0, 0.0)
    kind: str = "grasp"
    phase: str = ""

    async def run(self, context: TaskContext) -> str:
        arm, pilot = ArmWorkspace.of(context.description), context.pilot
        turret = arm.kinematics.skeleton(ArmJoints(0.0, 0.0, 0.0))[0, :2]
        ahead = np.array([*(np.array(self.place) - turret), 0.0])
        ahead /= np.linalg.norm(ahead)
        axes = np.array([ahead, np.cross((0.0, 0.0, 1.0), ahead), (0.0, 0.0, 1.0)])
        goal = np.array([*self.place, min(self.height / 2.0, 0.06)]) + np.array(self.off) @ axes
        before = arm.pose_at(goal - BEFORE * ahead, arm.claw_max)
        assert isinstance(before, ArmPose), before
        out = found(path_to(context.description.arm.stowed.pose(), before, arm))
        await pilot.follow_arm(out.timed(arm, 0.3))
        reach = found(straight_path(before, goal, arm))
        await pilot.follow_arm(reach.timed(arm))
        grip = closed(reach.end, self.width)
        await pilot.move_arm(grip)
        self.phase = "lifting"
        await pilot.follow_arm(found(lift_path(grip, arm)).timed(arm, LIFT_SPEED))
        return "lifted"


def found(path: ArmPath | Unreachable) -> ArmPath:
    assert isinstance(path, ArmPath), path
    return path


def stage(thing: Mapping[str, Any], reach: float, rotation: float) -> tuple[Scene, tuple[float, float]]:
    """A hall with the thing at this way [m] and angle from the axis of servo A, turned by 10 degrees."""
    place = (0.02 + reach * math.cos(rotation), -0.045 + reach * math.sin(rotation))
    yaw_deg = math.degrees(rotation) + 10.0
    objects = [{**thing, "name": "thing", "position": place, "yaw_deg": yaw_deg}]
    return Scene.model_validate({"title": "Hall", "room": HALL.model_dump(), "objects": objects}), place


def play(scene: Scene, scenario: Callable[[Rig], Any], description: RobotDescription = ROBOT) -> None:
    async def run() -> None:
        def robot(clock: ManualClock) -> InlineSimRobot:
            return InlineSimRobot(description, scene, clock, has_pictures=False)

        async with running_rig(robot) as rig:
            await scenario(rig)

    asyncio.run(run())


async def thing_in(rig: Rig) -> tuple[float, float]:
    """Height of the thing's middle above the floor, and how far it is from the gripping point [m]."""
    truth = await ask_truth(rig.robot)
    middle = np.array(truth.object("thing").centre_in_world)
    return float(middle[2]), float(np.linalg.norm((middle - np.array(truth.world_from_gripper)[:3, 3])[:2]))


async def lifts_and_holds(rig: Rig, grasp: Grasp) -> None:
    before, _ = await thing_in(rig)
    rig.runner.start(grasp, OPERATOR)
    progress = await rig.finish()
    assert progress.state is TaskState.DONE, progress.message
    lifted, apart = await thing_in(rig)
    assert lifted > before + 0.06
    await rig.advance(HOLD_S)
    held, still_apart = await thing_in(rig)
    assert held == pytest.approx(lifted, abs=0.003)
    assert still_apart == pytest.approx(apart, abs=0.003)


def grasp_of(scene: Scene, place: tuple[float, float], off: tuple[float, float, float]) -> Grasp:
    thing = scene.objects[0]
    return Grasp(thing.width, thing.tall, place, off)


@pytest.mark.parametrize("name", THINGS)
def test_thing_a_few_millimetres_from_where_it_is_taken_to_be_is_lifted_and_held(name: str) -> None:
    rng = np.random.default_rng(list(THINGS).index(name))
    scene, place = stage(THINGS[name], reach=rng.uniform(0.23, 0.27), rotation=rng.uniform(-0.5, 0.25))
    off = (rng.uniform(-0.008, 0.008), rng.choice((-0.003, 0.003)), rng.uniform(-0.004, 0.004))
    play(scene, lambda rig: lifts_and_holds(rig, grasp_of(scene, place, off)))


def test_arm_described_by_its_joints_grasps_as_well() -> None:
    scene, place = stage(BOX, reach=0.25, rotation=0.2)
    description = chain_instead_of_sizes(ROBOT)
    assert isinstance(description.arm.kinematics(), ChainArm)
    play(scene, lambda rig: lifts_and_holds(rig, grasp_of(scene, place, (0.0, 0.002, 0.0))), description)


def test_claw_that_closes_beside_the_thing_lifts_nothing() -> None:
    scene, place = stage(BOX, reach=0.25, rotation=0.0)

    async def scenario(rig: Rig) -> None:
        rig.runner.start(grasp_of(scene, place, (0.0, 0.0, 0.085)), OPERATOR)
        await rig.finish()
        height, apart = await thing_in(rig)
        assert height == pytest.approx(0.03, abs=0.005)
        assert apart > 0.01

    play(scene, scenario)


def test_stop_while_lifting_holds_the_arm_and_what_is_in_the_claw() -> None:
    scene, place = stage(THINGS["can"], reach=0.25, rotation=0.0)
    grasp = grasp_of(scene, place, (0.0, 0.0, 0.0))

    async def scenario(rig: Rig) -> None:
        rig.runner.start(grasp, OPERATOR)
        await rig.until(lambda: grasp.phase == "lifting")
        await rig.advance(0.8)
        rig.loop.stop("stopped")
        assert (await rig.finish()).state is not TaskState.DONE
        await rig.advance(0.2)
        height, _ = await thing_in(rig)
        assert 0.0575 + 0.02 < height < 0.0575 + 0.08, "on its way up"
        await rig.advance(HOLD_S)
        still, _ = await thing_in(rig)
        assert still == pytest.approx(height, abs=0.002)

    play(scene, scenario)
