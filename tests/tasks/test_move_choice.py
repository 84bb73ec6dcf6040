"""The chosen move keeps the target in the picture, keeps its distance, and tells more than the paper's."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.next_view import relative_sds_after
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.ray import Ray
from tapreach.tasks.candidate_moves import NEAREST, Grid, is_seen_and_clear
from tapreach.tasks.guessing import guesses_for
from tapreach.tasks.move_choice import FREE_OF_CHARGE, MoveCosts, Score, bound_score, choose_move
from tapreach.tasks.sighting import Sighting, observation_of, ray_of
from tapreach.tasks.supposed_distance import UNKNOWN, supposed_distances
from tasks.rig import sim_description

ROBOT = sim_description()
START = PlanarPose(0.4, -0.3, 0.5)


def in_camera(point_in_world: NDArray[np.float64], pose: PlanarPose) -> NDArray[np.float64]:
    world_from_camera = pose.to_rigid() * ROBOT.camera.mount.base_from_camera()
    return np.asarray(world_from_camera.inv().apply(point_in_world))


def seen(point_in_world: NDArray[np.float64], pose: PlanarPose, sigma: float = 0.5) -> Sighting:
    projection = ROBOT.camera.model().project(in_camera(point_in_world, pose)[None])
    assert projection.is_inside[0]
    return Sighting(1, 1, Pixel(*map(float, projection.pixels[0])), sigma, 1.0, pose)


def ahead(distance: float, left: float = 0.0, up: float = 0.05) -> NDArray[np.float64]:
    return np.asarray(START.to_rigid().apply(np.array([distance, left, up])))


@pytest.mark.parametrize("distance", [0.5, 0.8, 1.5, 3.0])
@pytest.mark.parametrize("side", [-0.2, 0.0, 0.2])
def test_chosen_move_keeps_the_target_in_view_and_at_a_distance(distance: float, side: float) -> None:
    point = ahead(distance, side * distance)
    choice = choose_move([seen(point, START)], START, [point], 0.42, ROBOT)
    assert choice is not None
    end = START.after(choice.step)
    seen(point, end)
    assert np.linalg.norm(in_camera(point, end)) >= NEAREST
    assert 0.0 < choice.step.advance <= 0.42


def exhaustive(score: Score, point: NDArray[np.float64], start: PlanarPose, most: float) -> float:
    """The best relative sd of all turns and advances in small steps that keep the target seen and clear."""
    turns, advances = np.radians(np.arange(-60.0, 60.1, 1.0)), np.arange(0.03, most + 1e-9, 0.01)
    stages = Grid(turns, advances).stages_in_world(start)
    stages = stages[is_seen_and_clear(stages, point, ROBOT)]
    return float(score(point, stages).min())


@settings(deadline=None, max_examples=6)
@given(
    distance=st.floats(0.55, 4.0),
    side=st.floats(-0.3, 0.3),
    turned=st.floats(-0.2, 0.2),
    driven=st.floats(0.0, 0.15),
)
def test_chosen_move_is_within_two_percent_of_an_exhaustive_search(
    distance: float, side: float, turned: float, driven: float
) -> None:
    point = ahead(distance, side * distance)
    here = START.after(PlanarStep(turned, driven))
    assume(is_seen_and_clear(here.to_rigid().as_matrix()[None], point, ROBOT))
    sightings = [seen(point, START), seen(point, here)] if driven > 0.01 else [seen(point, START)]
    score = bound_score(sightings, ROBOT)
    here = sightings[-1].world_from_base
    choice = choose_move(sightings, here, [point], 0.4, ROBOT, costs=FREE_OF_CHARGE)
    assume(choice is not None)
    assert choice is not None
    assert choice.relative_sd <= 1.02 * exhaustive(score, point, here, 0.4)


@pytest.mark.parametrize(("distance", "times"), [(1.0, 2.3), (2.5, 2.5), (5.0, 2.5)])
def test_chosen_move_beats_the_papers_by_far(distance: float, times: float) -> None:
    """One view at the end, clicks to 1 px, odometry to 1 %; at 1 m the edge of the picture forbids more."""
    point = ahead(distance, 0.0, 0.0)
    noise = OdometryNoise.per_step(0.01)

    def one_more_view(target: NDArray[np.float64], ways: NDArray[np.float64]) -> NDArray[np.float64]:
        known = [observation_of(seen(target, START, 1.0), ROBOT)]
        return relative_sds_after(known, noise, None, target, ways[:, [0, 2]], (1.0, 1.0))

    choice = choose_move(
        [seen(point, START)], START, [point], 0.5, ROBOT, costs=FREE_OF_CHARGE, score=one_more_view
    )
    assert choice is not None
    paper = Grid(np.array([math.radians(12.0)]), np.array([0.2])).stages_in_world(START)[0]
    assert choice.relative_sd < one_more_view(point, paper)[0] / times


def test_longer_way_is_not_taken_than_allowed() -> None:
    point = ahead(2.0)
    choice = choose_move([seen(point, START)], START, [point], 0.1, ROBOT)
    assert choice is not None and choice.step.advance <= 0.1
    assert choose_move([seen(point, START)], START, [point], 0.01, ROBOT) is None


def test_limits_of_the_way_hold_in_the_refined_move_too() -> None:
    point = ahead(1.5)
    for most, back in ((0.3, 0.0), (0.05, 0.2), (0.3, 0.1)):
        choice = choose_move([seen(point, START)], START, [point], most, ROBOT, most_back=back)
        assert choice is not None and -back - 1e-9 <= choice.step.advance <= most + 1e-9


def test_with_no_room_ahead_it_backs_off_where_that_is_free() -> None:
    point = ahead(0.34, 0.0, 0.06)
    assert choose_move([seen(point, START)], START, [point], 0.5, ROBOT) is None
    choice = choose_move([seen(point, START)], START, [point], 0.5, ROBOT, most_back=0.2)
    assert choice is not None and choice.step.advance < -0.05


def test_way_is_not_driven_for_more_than_what_is_wanted() -> None:
    point = ahead(1.0)
    best = choose_move([seen(point, START)], START, [point], 0.5, ROBOT)
    assert best is not None
    enough = MoveCosts(good_enough=2.0 * best.relative_sd)
    choice = choose_move([seen(point, START)], START, [point], 0.5, ROBOT, costs=enough)
    assert choice is not None and choice.step.advance < 0.8 * best.step.advance
    assert choice.relative_sd <= 2.0 * best.relative_sd * 1.02


def test_impossibly_near_supposition_is_given_up() -> None:
    near, far = ahead(0.34, 0.0, 0.02), ahead(0.6, 0.0, 0.02)
    assert choose_move([seen(far, START)], START, [near], 0.42, ROBOT) is None
    assert choose_move([seen(far, START)], START, [near, far], 0.42, ROBOT) is not None


def test_guesses_hit_the_place_for_the_right_distance() -> None:
    point = ahead(1.3, 0.1)
    before = seen(point, START)
    later = START.after(PlanarStep(0.1, 0.2))
    distance = float(np.linalg.norm(in_camera(point, START)))
    (guess,) = guesses_for(before, later, ROBOT, [distance])
    expected = seen(point, later).pixel
    assert (guess.u, guess.v) == pytest.approx((expected.u, expected.v), abs=1e-6)
    assert guess.scale == pytest.approx(in_camera(point, START)[2] / in_camera(point, later)[2])


def test_guesses_outside_the_picture_are_left_out() -> None:
    before = seen(ahead(1.3), START)
    assert guesses_for(before, START.after(PlanarStep(1.5, 0.0)), ROBOT) == ()


def test_floor_bounds_the_supposed_distance_from_above() -> None:
    ray = ray_of(seen(ahead(1.0, 0.0, 0.0), START), ROBOT)
    distances = supposed_distances(ray, None)
    assert list(distances) == sorted(distances)
    assert distances[-1] == pytest.approx(np.hypot(0.9, 0.15), abs=1e-3)
    farther = supposed_distances(ray, None, math.radians(1.0))
    assert farther[:-1] == distances[:-1]
    assert farther[-1] == pytest.approx(np.hypot(0.9, 0.15) * 1.11, rel=0.02)


def test_estimate_gives_its_interval_and_its_middle() -> None:
    point = ahead(1.0, 0.1)
    views = [observation_of(seen(point, pose), ROBOT) for pose in (START, START.after(PlanarStep(0.2, 0.3)))]
    estimate = estimate_point(views, OdometryNoise())
    assert estimate.range_interval_95 is not None and estimate.range is not None
    low, high = estimate.range_interval_95
    ray = ray_of(seen(point, START), ROBOT)
    assert supposed_distances(ray, estimate) == pytest.approx((low, estimate.range, high))


def test_first_move_by_the_floor_alone_tells_nearly_as_much_as_the_best_for_the_true_range() -> None:
    """Things of some centimetres on the floor; what may be too near ends the move there, as on the robot."""
    losses = []
    for distance in (0.7, 1.0, 1.5, 2.2, 3.0):
        for side, up in ((-0.3, 0.01), (0.0, 0.09), (0.2, 0.05)):
            point = ahead(distance, side * distance, up)
            first = seen(point, START, 0.3)
            ray = ray_of(first, ROBOT)
            supposed = [ray.at(each) for each in supposed_distances(ray, None, math.radians(0.5))]
            chosen = choose_move([first], START, supposed, 0.5, ROBOT)
            best = choose_move([first], START, [point], 0.5, ROBOT)
            assert chosen is not None and best is not None
            grid = Grid(np.array([chosen.step.turn]), np.linspace(0.05, chosen.step.advance, 12))
            ways = grid.stages_in_world(START)[0]
            ways = ways[is_seen_and_clear(ways, point, ROBOT)]
            losses.append(bound_score([first], ROBOT)(point, ways)[-1] / best.relative_sd)
    assert np.median(losses) < 1.25
    assert max(losses) < 1.6


def test_above_the_horizon_any_distance_is_supposed() -> None:
    assert supposed_distances(Ray(np.array([0.0, 0.0, 0.2]), np.array([1.0, 0.0, 0.1])), None) == UNKNOWN
