"""What one look has shown stays known until later ones that should show it do not."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.remembered import FARTHEST, Look, Remembered, after_look
from tapreach.tasks.fetch.sight import Sight
from tasks.fetch.worlds import ROBOT, moved_obstacle, obstacle_at

SIGHT = Sight.of(ROBOT)
FAR_GOAL = obstacle_at("it", 1.5, 0.0, 0.03)
HERE = PlanarPose()
SEEN = obstacle_at("something", 0.8, 0.15, 0.03)
places = st.builds(PlanarPose, st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3))


def look_from(pose: PlanarPose = HERE, frame_id: int = 1, goal: Obstacle = FAR_GOAL) -> Look:
    return Look(frame_id, {frame_id: pose}, SIGHT, goal)


def after(looks: list[tuple[list[Obstacle], Look]]) -> tuple[Remembered, ...]:
    known: tuple[Remembered, ...] = ()
    for found, look in looks:
        known = after_look(known, found, look)
    return known


def is_at(known: Remembered, obstacle: Obstacle, poses: dict[int, PlanarPose] | None = None) -> bool:
    there = known.in_world(poses or {})
    return np.allclose([there.start, there.end], [obstacle.start, obstacle.end], atol=1e-9)


def test_what_left_the_picture_stays_known_where_it_stands() -> None:
    near = HERE.after(PlanarStep(0.0, 0.75))
    looks = [([SEEN], look_from()), *[([], look_from(near, frame)) for frame in range(2, 8)]]
    (known,) = after(looks)
    assert is_at(known, SEEN)


@pytest.mark.parametrize("shown", [1, 2, 3])
def test_what_is_not_seen_where_it_should_be_is_forgotten(shown: int) -> None:
    look = look_from()
    seen, missing = [([SEEN], look)] * shown, ([], look)
    patience = 1 + min(shown, 2)
    assert len(after([*seen, *[missing] * (patience - 1)])) == 1
    assert after([*seen, *[missing] * patience]) == ()


def test_what_stands_behind_something_is_not_missed() -> None:
    before = obstacle_at("something", 0.55, 0.08, 0.05)
    looks = [([SEEN], look_from()), *[([before], look_from())] * 3]
    assert any(is_at(each, SEEN) for each in after(looks))
    hides = look_from(goal=obstacle_at("it", 0.6, 0.09, 0.05))
    assert any(is_at(each, SEEN) for each in after([([SEEN], look_from()), *[([], hides)] * 3]))


def test_what_is_too_far_to_be_seen_is_not_missed() -> None:
    far = obstacle_at("something", FARTHEST + 0.3, 0.1, 0.03)
    assert len(after([([far], look_from()), *[([], look_from())] * 3])) == 1


@given(places, st.integers(1, 5))
def test_same_thing_seen_again_and_again_is_one_thing(pose: PlanarPose, times: int) -> None:
    there = moved_obstacle(SEEN, pose)
    look = look_from(pose, goal=moved_obstacle(FAR_GOAL, pose))
    nearby = replace(there, start=there.start + 0.005, end=there.end + 0.005)
    (known,) = after([([there], look)] * times + [([nearby], look)])
    assert is_at(known, nearby)
    assert known.looks == times + 1
    assert known.is_sure


def test_what_is_half_out_of_the_picture_does_not_replace_the_whole() -> None:
    beside = HERE.after(PlanarStep(math.radians(-25.0), 0.3))
    assert not look_from(beside).is_whole(SEEN)
    half = replace(SEEN, start=SEEN.start + 0.01, end=SEEN.end + 0.01, radius=0.01)
    (known,) = after([([SEEN], look_from()), ([half], look_from(beside, 2))])
    assert is_at(known, SEEN)
    assert known.looks == 2


@given(places, places)
def test_things_go_where_their_view_is_later_known_to_have_been_taken(
    told: PlanarPose, corrected: PlanarPose
) -> None:
    seen = moved_obstacle(SEEN, told)
    (known,) = after_look((), [seen], look_from(told, 7))
    assert is_at(known, seen)
    assert is_at(known, moved_obstacle(SEEN, corrected), {7: corrected})


def test_two_things_side_by_side_stay_two() -> None:
    other = obstacle_at("something", 0.8, -0.15, 0.03)
    assert len(after([([SEEN, other], look_from())] * 3)) == 2
