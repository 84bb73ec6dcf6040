"""A step back to look for what is lost: as far as the floor behind is known to be free, facing the thing."""

import asyncio
import math

import pytest

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.clock import MS
from tapreach.tasks.fetch import stepping_back
from tapreach.tasks.fetch.facing import turn_to_face
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.fetch.stepping_back import BACK, found_from_farther
from tapreach.tasks.fetch.thing import Thing
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import obstacle_at, thing_at
from tasks.rig import bare_context

FOUND = Tap(7, 300.0, 200.0)


class Standing(FetchRun):
    """A fetch whose thing stands where it is said to."""

    known_to_stand: Thing

    def thing(self) -> Thing:
        return self.known_to_stand


class Drives:
    """A pilot whose base does at once as it is told."""

    def __init__(self, run: FetchRun) -> None:
        self.run, self.steps = run, list[PlanarStep]()

    async def advance(self, distance: float, share: float = 1.0) -> None:
        await self.move(PlanarStep(0.0, distance))

    async def move(self, step: PlanarStep) -> None:
        self.steps.append(step)
        poses = self.run.context.poses
        time_ns, here = poses.newest()
        poses.add(time_ns + 100 * MS, here.after(step))


def after_driving(way: float, thing: Thing, *others: Obstacle) -> tuple[FetchRun, Drives]:
    """A fetch that has come straight ahead by `way` [m]."""
    context = bare_context()
    steps = 20
    for i in range(steps + 1):
        context.poses.add((1 + i) * 100 * MS, PlanarPose(way * (i / steps - 1.0), 0.0, 0.0))
    run = Standing(context, FetchMemory(Tap(1, 1.0, 1.0), 1, Mode.GO), others, None)  # type: ignore[arg-type]
    run.known_to_stand = thing
    drives = Drives(run)
    object.__setattr__(context, "pilot", drives)
    return run, drives


@pytest.fixture
def sees(monkeypatch: pytest.MonkeyPatch) -> None:
    async def found(run: FetchRun) -> Tap:
        return FOUND

    monkeypatch.setattr(stepping_back, "tap_again", found)


@pytest.mark.parametrize(("way", "back"), [(1.0, BACK), (0.12, 0.12)])
def test_it_backs_off_where_it_came_from_and_faces_the_thing(way: float, back: float, sees: None) -> None:
    run, drives = after_driving(way, thing_at(0.3, 0.12))
    assert asyncio.run(found_from_farther(run)) == FOUND
    assert [drives.steps[0].turn, drives.steps[0].advance] == pytest.approx([0.0, -back], abs=0.02)
    x, y, _ = run.thing().point_in_world
    assert run.here.heading == pytest.approx(math.atan2(y - run.here.y, x - run.here.x))


def test_thing_right_ahead_needs_no_turn(sees: None) -> None:
    run, drives = after_driving(1.0, thing_at(0.4, 0.0))
    asyncio.run(found_from_farther(run))
    assert [step.turn for step in drives.steps] == [0.0]


def test_without_room_it_does_not_move_and_looks_no_second_time(sees: None) -> None:
    run, drives = after_driving(0.0, thing_at(0.0, 0.9), obstacle_at("box", -0.12, 0.12, 0.02))
    assert turn_to_face(run) is None
    assert asyncio.run(found_from_farther(run)) is None
    assert drives.steps == []
