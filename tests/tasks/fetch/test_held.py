"""The robot knows where its claw is, and whether it holds something, in the rendered simulator."""

import asyncio
import math
from dataclasses import dataclass

import numpy as np
import pytest

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.estimation.arm_offsets import ArmOffsets, NoOffsets
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.seen_arm import SeenArm
from tapreach.robot.clock import SECOND, ManualClock
from tapreach.robot.messages import ArmPose, ArmState
from tapreach.tasks.fetch.arm_zero import ArmZero, zeroed_arm
from tapreach.tasks.fetch.held import (
    Held,
    HeldPicture,
    HeldVerdict,
    held_in,
    look_whether_held,
    stopped_short,
)
from tapreach.tasks.task import TaskContext
from tasks.rig import bare_context, running_rig, sim_description

CAN = (0.9, -0.045)
SCENE = Scene.model_validate(
    {
        "title": "A can to be held",
        "room": {"floor": "planks"},
        "objects": [{"kind": "can", "position": CAN, "radius": 0.03, "name": "can"}],
    }
)
FAULTS = SimFaults(servo_offset_deg=3.0, mount_yaw_deg=1.0, mount_up=0.005, camera_delay_ms=80.0)
AROUND = 0.29


@dataclass
class Grasp:
    """Looks at the claw, looks whether it is held while empty, grips the can, and looks again."""

    kind = "grasp"
    robot: InlineSimRobot
    took: float = 0.0
    zero: ArmZero | None = None
    error: FloatArray | None = None
    empty: Held | None = None
    full: Held | None = None
    risen: float = 0.0

    async def run(self, context: TaskContext) -> str:
        start_ns = context.clock.now_ns()
        self.zero = await zeroed_arm(context)
        self.took = (context.clock.now_ns() - start_ns) / SECOND
        arm = self.zero.seen_arm(context.description.camera.mount.base_from_camera())
        assert arm is not None
        self.empty = await look_whether_held(context, self.zero, 0.06)
        self.error = await self._tip_error(context, arm)
        self.robot.place_base(PlanarPose(CAN[0] - AROUND, 0.0, 0.0))
        await self._grip(context, arm)
        self.full = await look_whether_held(context, self.zero, 0.06)
        self.risen = (await ask_truth(self.robot)).object("can").centre_in_world[2] - 0.0575
        return "done"

    async def _tip_error(self, context: TaskContext, arm: SeenArm) -> FloatArray:
        """Where the camera is told that the tip is, less where it truly is in the camera's frame."""
        await self._go(context, arm, (0.26, -0.05, 0.06), 0.03)
        sent = arm.inverse((0.26, -0.05, 0.06)).joints
        truth = await ask_truth(self.robot)
        camera_from_gripper = np.linalg.inv(truth.world_from_camera) @ np.array(truth.world_from_gripper)
        assert self.zero is not None and isinstance(self.zero.offsets, ArmOffsets) and sent is not None
        return np.asarray(self.zero.offsets.tip_in_camera(sent) - camera_from_gripper[:3, 3])

    async def _grip(self, context: TaskContext, arm: SeenArm) -> None:
        for tip in ((0.20, -0.045, 0.14), (0.20, -0.045, 0.05)):
            await self._go(context, arm, tip, 0.073)
        for x in np.linspace(0.22, AROUND, 4):
            await self._go(context, arm, (x, -0.045, 0.05), 0.073)
        await self._go(context, arm, (AROUND, -0.045, 0.05), 0.0)
        await self._go(context, arm, (AROUND, -0.045, 0.09), 0.0)

    async def _go(
        self, context: TaskContext, arm: SeenArm, tip: tuple[float, float, float], claw: float
    ) -> None:
        joints = arm.inverse(tip).joints
        assert joints is not None
        await context.pilot.move_arm(ArmPose(joints.rotation, joints.shoulder, joints.elbow, claw))


@pytest.fixture(scope="module")
def grasp() -> Grasp:
    async def carry_out() -> Grasp:
        async with running_rig(lambda clock: _robot(clock)) as rig:
            assert isinstance(rig.robot, InlineSimRobot)
            task = Grasp(rig.robot)
            rig.runner.start(task, 1)
            progress = await rig.finish()
            assert task.full is not None, progress
            return task

    return asyncio.run(carry_out())


def _robot(clock: ManualClock) -> InlineSimRobot:
    return InlineSimRobot(sim_description(8.0), SCENE, clock, FAULTS, 3)


def test_claw_is_seen_within_ten_seconds_of_the_robots_time(grasp: Grasp) -> None:
    assert grasp.zero is not None
    assert grasp.zero.views >= 3
    assert grasp.took <= 10.0


def test_tip_is_known_in_the_cameras_frame_though_servos_stand_off(grasp: Grasp) -> None:
    assert grasp.zero is not None and isinstance(grasp.zero.offsets, ArmOffsets)
    assert grasp.error is not None
    assert np.linalg.norm(grasp.error) < 0.006
    # The servos stand off by 3 degrees, which is more than a centimetre at the tips.
    assert np.linalg.norm(grasp.zero.offsets.zeros) > math.radians(2.0)


def test_empty_claw_is_not_taken_for_a_holding_one(grasp: Grasp) -> None:
    assert grasp.empty is not None
    assert grasp.empty.verdict is HeldVerdict.NOT_HELD, grasp.empty
    assert "fingers met" in grasp.empty.reason


def test_thing_in_the_claw_is_seen_to_be_held(grasp: Grasp) -> None:
    assert grasp.full is not None
    assert grasp.risen > 0.02
    assert grasp.full.verdict is HeldVerdict.HELD, grasp.full
    assert grasp.full.opening == pytest.approx(0.06, abs=0.012)


def test_claw_that_was_never_seen_gives_no_verdict() -> None:
    zero = ArmZero(NoOffsets("the camera does not see the claw"), 0)
    held = asyncio.run(look_whether_held(bare_context(), zero))
    assert held.verdict is HeldVerdict.UNSURE
    assert "does not see" in held.reason


def test_broken_picture_gives_no_verdict(grasp: Grasp) -> None:
    assert grasp.zero is not None and isinstance(grasp.zero.offsets, ArmOffsets)
    sent = grasp.zero.offsets.arm.inverse((0.26, -0.05, 0.06)).joints
    assert sent is not None
    broken = HeldPicture(sent, b"no picture")
    held = held_in((broken, broken), grasp.zero.offsets, sim_description())
    assert held.verdict is HeldVerdict.UNSURE
    assert "cannot be used" in held.reason


@pytest.mark.parametrize(
    ("stands", "is_moving", "says"), [(0.06, False, True), (0.06, True, False), (0.001, False, False)]
)
def test_servo_tells_of_something_where_it_stopped_short(stands: float, is_moving: bool, says: bool) -> None:
    state = ArmState(1, ArmPose(0.0, 0.0, 0.0, stands), ArmPose(0.0, 0.0, 0.0, 0.0), is_moving)
    assert stopped_short(state) is says
