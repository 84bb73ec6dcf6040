"""Going back from where a move has hidden the target: to which side it was, and the way back."""

import asyncio
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.drivers.sim.scene import Scene, load_scene
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.going_back import LEAST_ASIDE, LostSide, way_back
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.move_choice import choose_move
from tapreach.tasks.optics import optics_of
from tapreach.tasks.sighting import ray_of
from tapreach.tasks.task import TaskState
from tasks.rig import OPERATOR, running_rig, sim_robot
from tasks.test_locate import in_odometry, tap_on
from tasks.test_move_choice import ROBOT, START, ahead, seen

POINT = ahead(1.5)
SIGHT = ray_of(seen(POINT, START), ROBOT)
places = st.floats(-3.0, 3.0)


def cameras_at(*poses: PlanarPose) -> np.ndarray:
    mount = optics_of(ROBOT.camera)[1]
    return np.array([(pose.to_rigid() * mount).translation for pose in poses])


def gone(turn_deg: float, way: float) -> PlanarPose:
    return START.after(PlanarStep(math.radians(turn_deg), way))


@given(places, places, places, st.floats(-1.5, 1.5), st.floats(-0.5, 0.5))
def test_way_back_leads_to_where_the_move_began(
    x: float, y: float, heading: float, turn: float, way: float
) -> None:
    start = PlanarPose(x, y, heading)
    here = start.after(PlanarStep(turn, way))
    for step in way_back(start, here):
        here = here.after(step)
    off = start.between(here)
    assert np.allclose([off.x, off.y, off.heading], 0.0, atol=1e-9)


def test_side_is_that_of_the_move_and_reaches_to_where_it_was_seen() -> None:
    for turn in (20.0, -20.0):
        side = LostSide.between(SIGHT, gone(turn, 0.2), gone(turn, 0.5), ROBOT)
        assert side is not None and side.is_left == (turn > 0.0)
        farther, nearer, other = cameras_at(gone(turn, 0.3), gone(turn, 0.1), gone(-turn, 0.5))
        assert list(side.hides_from(np.array([farther, nearer, other]))) == [True, False, False]


def test_move_straight_ahead_goes_to_neither_side() -> None:
    straight = LostSide.between(SIGHT, START, gone(math.degrees(LEAST_ASIDE) / 4.0, 0.5), ROBOT)
    assert straight is None


@pytest.mark.parametrize("is_left", [True, False])
def test_chosen_move_goes_to_the_other_side(is_left: bool) -> None:
    lost = LostSide(SIGHT, is_left, 0.0)
    choice = choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT, lost_sides=[lost])
    assert choice is not None
    (end,) = cameras_at(START.after(choice.step))
    assert not lost.hides_from(end)
    both = [lost, LostSide(SIGHT, not is_left, 0.0)]
    assert choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT, lost_sides=both) is None


def room_with_a_post(ahead: float, left: float) -> Scene:
    """A can 1.9 m ahead and, nearer, something tall beside the line of sight."""
    room = load_scene("room").model_dump(mode="json", exclude_unset=True)
    can = {"kind": "can", "name": "red can", "position": [1.9, 0.0]}
    post = {"kind": "box", "position": [ahead, left], "size": [0.1, 0.12, 0.34], "graspable": False}
    return Scene.model_validate({**room, "objects": [can, post]})


def test_thing_hidden_by_the_first_move_is_located_from_the_other_side() -> None:
    async def run() -> None:
        async with running_rig(sim_robot(room_with_a_post(0.7, 0.085))) as rig:
            await rig.advance(0.3)
            tap, truth = await tap_on(rig, "red can")
            rig.runner.start(LocateTask(tap, 1), OPERATOR)
            progress = await rig.finish()
            assert progress.state is TaskState.DONE, progress.message
            told = [each.message for each in rig.progress]
            assert any("going back, to look from the other side" in each for each in told), told
            target = rig.targets[-1]
            assert target.point_in_world is not None and target.range_interval is not None
            low, high = target.range_interval
            assert high / low < 1.12
            assert np.linalg.norm(target.point_in_world - await in_odometry(rig, truth)) < 0.1

    asyncio.run(run())
