"""A robot that something blocks on its way: it stops pushing, backs off, and knows that it stands there."""

import asyncio
from dataclasses import dataclass, field

import numpy as np

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.blocked import back_off_from
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.follower import Follower
from tapreach.tasks.locate_watch import BLOCKED
from tapreach.tasks.locating import Locating
from tapreach.tasks.target import TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap, TaskContext
from tasks.rig import OPERATOR, running_rig, sim_robot

WAY = 0.9


@dataclass
class PushesOn:
    """A task that drives on following a tap, and backs off from what blocks it; twice."""

    tap: Tap
    kind: str = "push"
    why: str = ""
    ended: list[Ended | None] = field(default_factory=list)
    run_of: FetchRun | None = None
    stood: list[PlanarPose] = field(default_factory=list)

    async def run(self, context: TaskContext) -> str:
        report = TargetReport(1, TargetSource.LOCATE, self.tap, context.description)
        locating = Locating(context, Follower(context, self.tap, key=1), report, 0.02)
        run = FetchRun(context, FetchMemory(self.tap, 1, Mode.GO), (), ArmWatch(context.robot.arm))
        self.run_of = run
        await locating.begin()
        self.why = await locating.drive(context.pilot.advance(WAY))
        for _ in range(2):
            self.stood.append(run.here)
            self.ended.append(await back_off_from(run, self.why))
        return "done"


def pushed() -> PushesOn:
    async def run() -> PushesOn:
        scene = load_scene("room")
        async with running_rig(sim_robot(scene)) as rig:
            assert isinstance(rig.robot, InlineSimRobot)
            rig.robot.place_base(PlanarPose(scene.room.x[1] - 0.5, -1.0, 0.0))
            await rig.advance(0.5)
            frame = rig.frames.store.newest
            assert frame is not None
            task = PushesOn(Tap(frame.frame_id, frame.size.width / 2.0, frame.size.height / 2.0))
            rig.runner.start(task, OPERATOR)
            await rig.finish()
            return task

    return asyncio.run(run())


def test_pushing_in_vain_ends_the_leg_and_the_robot_backs_off_once() -> None:
    task = pushed()
    assert task.why == BLOCKED
    first, again = task.ended
    assert first is None
    assert again is not None and again.outcome is Outcome.CANNOT and BLOCKED in again.why
    before, after = task.stood
    assert 0.05 < before.between(after).x * -1.0 < 0.2
    assert task.run_of is not None
    (met,) = task.run_of.around.in_world()
    ahead = before.to_rigid().inv().apply(np.array([*met.centre, 0.0]))
    assert 0.05 < ahead[0] < 0.2 and abs(ahead[1]) < 1e-6
