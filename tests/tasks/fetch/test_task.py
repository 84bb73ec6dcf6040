"""A whole fetch in the rendered world: from one tap to the thing in the claw, stopped on the way and gone on
with; and what is refused.
"""

import asyncio

import pytest

from tapreach.drivers.sim.truth import ask_truth
from tapreach.robot.clock import MS
from tapreach.tasks.fetch.after import FollowUp
from tapreach.tasks.fetch.fetch_state import Mode, Verb
from tapreach.tasks.fetch.states import Phase
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.task import Task, TaskState
from tasks.rig import OPERATOR, Rig
from tasks.test_locate import in_scene, tap_on

LIFTED = 0.02


def phases(rig: Rig) -> list[Phase]:
    """What it was at, in turn."""
    return [state.phase for state in rig.fetches if state is not None]


async def begun(rig: Rig, task: Task) -> None:
    rig.runner.start(task, OPERATOR)
    await rig.advance(0.02)


async def height_of(rig: Rig, name: str) -> float:
    return (await ask_truth(rig.robot)).object(name).centre_in_world[2]


def test_tapped_can_is_fetched_although_stopped_on_the_way_and_put_down_again() -> None:
    async def test(rig: Rig) -> None:
        before = await height_of(rig, "red can")
        tap, _ = await tap_on(rig, "red can")
        task = FetchTask(tap, 1)
        await begun(rig, task)
        while Phase.APPROACH not in phases(rig):
            await rig.clock.advance(20 * MS)
            assert rig.runner.is_running, rig.runner.progress
        rig.runner.cancel("stopped by a test")
        await rig.runner.wait()
        resumed = task.resumed(())
        assert resumed.memory.phase is Phase.LOOK and resumed.memory.zero is not None
        rig.runner.start(resumed, OPERATOR)
        progress = await rig.finish()
        assert progress.state is TaskState.DONE, progress
        assert phases(rig)[-1] is Phase.HELD
        await rig.advance(2.0)
        assert await height_of(rig, "red can") > before + LIFTED
        rig.runner.start(FollowUp(Verb.PUT_DOWN, resumed.memory), OPERATOR)
        assert (await rig.finish()).state is TaskState.DONE
        assert await height_of(rig, "red can") == pytest.approx(before, abs=0.005)
        assert rig.fetches[-1] is None

    in_scene("near", test)


def test_plan_of_a_large_parcel_refuses_it_and_touches_nothing() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "parcel")
        before = (await ask_truth(rig.robot)).object("parcel").centre_in_world
        rig.runner.start(FetchTask(tap, 1, Mode.PLAN), OPERATOR)
        progress = await rig.finish()
        assert phases(rig)[-1] in (Phase.REFUSED, Phase.PLANNED), progress
        assert Phase.ZERO not in phases(rig)
        assert (await ask_truth(rig.robot)).object("parcel").centre_in_world == pytest.approx(
            before, abs=0.005
        )

    in_scene("room", test)


def test_it_waits_for_the_operators_word_where_it_shall() -> None:
    async def test(rig: Rig) -> None:
        tap, _ = await tap_on(rig, "red can")
        task = FetchTask(tap, 1, Mode.CONFIRM)
        await begun(rig, task)
        while Phase.CONFIRM not in phases(rig):
            await rig.clock.advance(20 * MS)
            assert rig.runner.is_running, rig.runner.progress
        await rig.advance(1.0)
        assert phases(rig)[-1] is Phase.CONFIRM
        task.confirm()
        await rig.advance(0.1)
        assert phases(rig)[-1] is Phase.ZERO
        rig.runner.cancel("enough")
        await asyncio.wait_for(rig.runner.wait(), 10)

    in_scene("near", test)
