"""What a fetch leaves out when it is asked to, so that the parts can be measured."""

import asyncio
import math
from dataclasses import replace

import pytest

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.approaching import drive
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.fetch.ways import Ways
from tapreach.tasks.fixed_move import ADVANCE, TURN, fixed_step
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.task import Tap, TaskState
from tasks.fetch.worlds import ROBOT
from tasks.rig import OPERATOR, Rig, bare_context
from tasks.test_locate import in_scene, tap_on

LEG = Leg(PlanarStep(0.1, 0.3), 1.0, True)
BARE = Ways(use_background=False, renews_on_way=False, fixed_move=True)


class Wheels:
    def __init__(self) -> None:
        self.moves: list[PlanarStep] = []

    async def move(self, step: PlanarStep, arm: object) -> None:
        self.moves.append(step)


class Following:
    """Counts the motions during which it was followed."""

    def __init__(self) -> None:
        self.count = 0

    async def drive(self, motion) -> None:
        self.count += 1
        await motion


@pytest.mark.parametrize("renews", [True, False])
def test_leg_is_driven_but_followed_only_where_it_is_estimated_on(renews) -> None:
    wheels, following = Wheels(), Following()
    context = replace(bare_context(), pilot=wheels)
    context.poses.add(1, PlanarPose())
    memory = FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO)
    ways = Ways(renews_on_way=renews)
    run = FetchRun(context, memory, [], ArmWatch.__new__(ArmWatch), ways=ways, locating=following)
    asyncio.run(drive(run, LEG))
    assert wheels.moves == [LEG.step]
    assert following.count == int(renews)


def test_what_is_left_out_stays_left_out_after_a_stop() -> None:
    assert FetchTask(Tap(1, 1.0, 1.0), 1, ways=BARE).resumed(()).ways == BARE
    assert FetchTask(Tap(1, 1.0, 1.0), 1).resumed(()).ways == Ways()


@pytest.mark.parametrize(
    ("share", "turn"), [(0.1, TURN), (0.5, TURN), (0.65, TURN), (0.8, -TURN), (0.99, -TURN)]
)
def test_fixed_move_keeps_the_target_in_the_picture(share, turn) -> None:
    width, fx = ROBOT.camera.model().size.width, ROBOT.camera.model().fx
    first = Sighting(1, 1, Pixel(share * width, 200.0), 0.3, 1.0, PlanarPose())
    step = fixed_step(first, ROBOT)
    assert step == PlanarStep(turn, ADVANCE)
    assert 0.0 < share * width + math.copysign(TURN * fx, turn) < width


def test_fixed_move_is_made_instead_of_a_chosen_one() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        start = rig.context.poses.newest()[1]
        rig.runner.start(FetchTask(tap, 1, Mode.PLAN, ways=BARE), OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.DONE, progress
        way = start.between(rig.context.poses.newest()[1])
        # Finding out how late the camera is turns it a little too.
        assert abs(way.heading) == pytest.approx(TURN, abs=math.radians(5.0))
        assert math.hypot(way.x, way.y) == pytest.approx(ADVANCE, abs=0.01)
        assert not any(rig.moves), "no move is planned"

    in_scene("room", test)
