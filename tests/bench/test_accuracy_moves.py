"""The exhaustive search finds what there is to find, and the choice of the product stands beside it."""

from dataclasses import replace

import numpy as np
import pytest

from tapreach.bench.accuracy_exhaustive import (
    MOST_ADVANCE,
    ON_THE_WAY,
    TWO_TAPS,
    Keeping,
    Sight,
    best_move,
    is_kept,
    relative_sds,
)
from tapreach.bench.accuracy_moves import chosen_move, measure_moves
from tapreach.bench.accuracy_plan import smoke_plan
from tapreach.bench.accuracy_scene import (
    CAMERA,
    LEVER,
    PITCH,
    points_in_cameras,
    poses_after,
    project,
    target_at,
)
from tapreach.estimation.bound import position_bound
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount

SIGHT = Sight(np.array([0.05, -0.03, 0.5]), 1.0, 0.01)
KEEPING = Keeping(0.07, 0.25)


def seen_along(drive):
    poses = poses_after(drive.turns, drive.advances)
    point = target_at(SIGHT.target[None, :2], 1.0 / SIGHT.target[2:])
    pixels = project(points_in_cameras(poses, point))[0]
    mount = camera_mount(LEVER, PITCH)
    views = [
        Observation(Pixel(*pixel.tolist()), 1.0, CAMERA, PlanarPose(*pose.tolist()).to_rigid(), mount)
        for pixel, pose in zip(pixels, poses[0], strict=True)
    ]
    return views, point[0]


@pytest.mark.parametrize("views", [TWO_TAPS, ON_THE_WAY])
def test_score_is_the_bound_of_the_estimator(views):
    turns, advances = np.array([0.15]), np.array([0.3])
    observations, point = seen_along(views.drive(turns, advances))
    bound = position_bound(observations, point, OdometryNoise.per_step(0.01))
    assert relative_sds(SIGHT, views, turns, advances)[0] == pytest.approx(bound.relative_sd, rel=1e-6)


@pytest.mark.parametrize("views", [TWO_TAPS, ON_THE_WAY])
def test_no_move_tried_at_random_is_better_than_the_best(views):
    step, best = best_move(SIGHT, views, KEEPING)
    assert is_kept(SIGHT, step, KEEPING)
    random = np.random.default_rng(2)
    tried = [PlanarStep(*each) for each in random.uniform([-0.6, 0.03], [0.6, MOST_ADVANCE], (400, 2))]
    kept = [each for each in tried if is_kept(SIGHT, each, KEEPING)]
    turns, advances = np.array([(each.turn, each.advance) for each in kept]).T
    assert len(kept) > 50
    assert relative_sds(SIGHT, views, turns, advances).min() >= best * (1.0 - 1e-9)


def test_target_that_is_lost_or_hit_on_the_way_is_not_kept():
    assert is_kept(SIGHT, PlanarStep(0.1, 0.2), KEEPING)
    assert not is_kept(SIGHT, PlanarStep(0.6, 0.2), KEEPING)
    assert not is_kept(SIGHT, PlanarStep(0.1, 0.2), Keeping(0.07, 1.9))


@pytest.mark.parametrize("views", [TWO_TAPS, ON_THE_WAY])
def test_chosen_move_is_in_the_better_of_two_valleys(views):
    # Low in the picture: little turn and a short way, or so much turn that the target allows a longer one.
    sight = Sight(np.array([-0.174, 0.121, 1.0]), 1.0, 0.01)
    step = chosen_move(sight, views)
    (chosen,) = relative_sds(sight, views, np.array([step.turn]), np.array([step.advance]))
    assert chosen <= 1.02 * best_move(sight, views, KEEPING)[1]


def test_every_depth_and_protocol_is_in_the_table():
    section = measure_moves(replace(smoke_plan(5), targets=2))
    assert {row[0].split(",")[0] for row in section.grid.rows} == {"0.5 m", "1 m", "2.5 m", "5 m"}
    assert [figure.limit is None for figure in section.figures] == [False, False, False, True, False, True]
    assert all(figure.value is not None for figure in section.figures)
