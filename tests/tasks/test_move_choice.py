"""The chosen move keeps the target in the picture, keeps its distance, and tells more than the paper's."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from tapreach.estimation.bound import position_bound
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.ray import Ray
from tapreach.tasks.estimating import mount_noise, odometry_noise
from tapreach.tasks.guessing import guesses_for
from tapreach.tasks.move_choice import NEAREST, choose_move
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


def relative_sd(point: NDArray[np.float64], step: PlanarStep) -> float:
    views = [observation_of(seen(point, pose, 0.7), ROBOT) for pose in (START, START.after(step))]
    bound = position_bound(views, point, odometry_noise(ROBOT), mount_noise(ROBOT))
    assert bound is not None
    return bound.relative_sd


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


@pytest.mark.parametrize("distance", [1.0, 2.5])
def test_chosen_move_beats_the_papers(distance: float) -> None:
    point = ahead(distance)
    choice = choose_move([seen(point, START)], START, [point], 0.42, ROBOT)
    assert choice is not None
    assert relative_sd(point, choice.step) < relative_sd(point, PlanarStep(math.radians(12.0), 0.2))


def test_longer_way_is_not_taken_than_allowed() -> None:
    point = ahead(2.0)
    choice = choose_move([seen(point, START)], START, [point], 0.1, ROBOT)
    assert choice is not None and choice.step.advance <= 0.1
    assert choose_move([seen(point, START)], START, [point], 0.01, ROBOT) is None


def test_target_that_may_be_near_keeps_the_first_advance_short() -> None:
    near, far = ahead(0.5), ahead(3.0)
    both = choose_move([seen(far, START)], START, [near, far], 0.42, ROBOT)
    only_far = choose_move([seen(far, START)], START, [far], 0.42, ROBOT)
    assert both is not None and only_far is not None
    assert both.step.advance < only_far.step.advance


def test_impossibly_near_supposition_is_given_up() -> None:
    near, far = ahead(0.36, 0.0, 0.02), ahead(0.6, 0.0, 0.02)
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


def test_above_the_horizon_any_distance_is_supposed() -> None:
    assert supposed_distances(Ray(np.array([0.0, 0.0, 0.2]), np.array([1.0, 0.0, 0.1])), None) == UNKNOWN
