"""Locating turns and drives into nothing that it was told of."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.candidate_moves import Grid
from tapreach.tasks.clear_moves import ClearMoves
from tapreach.tasks.fetch.obstacle import Obstacle, Surroundings
from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.move_choice import choose_move
from tasks.fetch.worlds import obstacle_at
from tasks.test_move_choice import ROBOT, START, ahead, seen

POINT = ahead(1.5)
OUTLINE = Outline.of(ROBOT)
GRID = Grid(np.radians([-40.0, -15.0, 0.0, 15.0, 40.0]), np.array([0.1, 0.25, 0.5]))


def beside(forward: float, left: float, radius: float = 0.04) -> Obstacle:
    x, y, _ = ahead(forward, left)
    return obstacle_at("target 2", float(x), float(y), radius, 0.004)


def least_gap(obstacles: list[Obstacle], step: PlanarStep) -> float:
    """The least way between the base and any of them on all of a move."""
    turned = START.after(PlanarStep(step.turn, 0.0))
    poses = [START.after(PlanarStep(float(turn), 0.0)) for turn in np.linspace(0.0, step.turn, 30)]
    poses += [turned.after(PlanarStep(0.0, float(way))) for way in np.linspace(0.0, step.advance, 30)]
    around = Surroundings.of(obstacles)
    return min(float(around.clearances(OUTLINE.at(pose)).min()) for pose in poses)


@settings(deadline=None, max_examples=8)
@given(st.lists(st.tuples(st.floats(0.3, 0.9), st.floats(0.1, 0.5), st.booleans()), min_size=1, max_size=3))
def test_chosen_move_runs_over_nothing_that_stands_beside(places: list[tuple[float, float, bool]]) -> None:
    obstacles = [beside(forward, left if is_left else -left) for forward, left, is_left in places]
    choice = choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT, keep_clear=obstacles)
    if choice is not None:
        assert least_gap(obstacles, choice.step) >= min(0.003, least_gap(obstacles, PlanarStep(0.0, 0.0)))


def test_move_that_would_run_over_something_is_replaced_by_one_that_does_not() -> None:
    freely = choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT)
    assert freely is not None
    x, y = (lambda pose: (pose.x, pose.y))(START.after(freely.step).after(PlanarStep(0.0, 0.1)))
    there = obstacle_at("target 2", x, y, 0.03)
    choice = choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT, keep_clear=[there])
    assert choice is not None and choice.step != freely.step
    assert least_gap([there], choice.step) > 0.0


def test_what_is_far_away_changes_nothing() -> None:
    freely = choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT)
    far = [beside(-1.0, 0.0), beside(1.0, 1.2)]
    assert choose_move([seen(POINT, START)], START, [POINT], 0.5, ROBOT, keep_clear=far) == freely


def test_target_told_of_before_is_not_in_its_own_way() -> None:
    itself = Obstacle("target 1", ahead(0.3)[:2], ahead(3.0)[:2], 0.05, 0.01)
    assert ClearMoves([itself], [ahead(1.0), ahead(2.0)], START, ROBOT).of(GRID).all()


def test_thing_told_where_the_robot_stands_hinders_no_move() -> None:
    under = obstacle_at("target 2", START.x, START.y, 0.05)
    assert ClearMoves([under], [POINT], START, ROBOT).of(GRID).all()


@given(st.floats(0.3, 0.8), st.floats(-0.4, 0.4))
def test_longer_way_is_never_clear_where_a_shorter_one_is_not(forward: float, left: float) -> None:
    target = START.after(PlanarStep(math.radians(170.0), 2.0))
    clear = ClearMoves([beside(forward, left)], [np.array([target.x, target.y, 0.0])], START, ROBOT).of(GRID)
    assert (clear[:, :-1] | ~clear[:, 1:]).all()
