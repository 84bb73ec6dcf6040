"""The peers of the accuracy bench are used as they are meant to be: exact sightings give the exact target."""

import dataclasses

import numpy as np
import pytest

from tapreach.bench.accuracy_gtsam import gtsam_peers
from tapreach.bench.accuracy_peers import from_point, opencv, paper, tapreach, tapreach_trusting
from tapreach.bench.accuracy_trials import DEPTHS, VIEWS, Cell, draw_trials
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.pose import camera_mount

EXACT = {"opencv": opencv, "tapreach": tapreach, "trusting": tapreach_trusting, **gtsam_peers()}


def exact_sightings(depth, views):
    trials = draw_trials(Cell(depth, views, 1e-9, 0.0), 1, np.random.default_rng(1))
    seen = [dataclasses.replace(view, pixel_sigma=1.0) for view in next(trials.sightings())]
    return seen, trials.targets[0]


@pytest.mark.parametrize("name", EXACT)
@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("views", VIEWS)
def test_exact_sightings_give_the_exact_target(name, depth, views):
    observations, truth = exact_sightings(depth, views)
    job = EXACT[name](observations, Cell(depth, views, 1.0, 0.01))
    np.testing.assert_allclose(job.read(job.run()).target, truth, rtol=1e-5)


def test_graph_of_gtsam_agrees_with_the_estimate_and_its_covariance():
    pytest.importorskip("gtsam", reason="gtsam is not installed: no oracle")
    cell = Cell(1.0, 5, 1.0, 0.01)
    observations = next(draw_trials(cell, 1, np.random.default_rng(4)).sightings())
    own, other = (peer(observations, cell) for peer in (tapreach, gtsam_peers()["gtsam MAP"]))
    mine, theirs = own.read(own.run()), other.read(other.run())
    sd = np.sqrt(np.diag(mine.covariance))
    assert np.all(np.abs(mine.target - theirs.target) < 0.02 * sd)
    np.testing.assert_allclose(
        theirs.covariance / np.outer(sd, sd), mine.covariance / np.outer(sd, sd), atol=0.02
    )


def test_paper_is_exact_only_without_lever_and_pitch():
    observations, truth = exact_sightings(1.0, 2)
    job = paper(observations, Cell(1.0, 2, 1.0, 0.01))
    assert abs(job.read(job.run()).target[2] / truth[2] - 1.0) > 0.1
    level = camera_mount((0.0, 0.0, 0.15))
    moved = [dataclasses.replace(view, base_from_camera=level) for view in observations]
    point = np.array([*truth[:2], 1.0]) / truth[2]
    pixels = [
        v.camera.project((v.world_from_camera.inv() * moved[0].world_from_camera).apply(point)[None])
        for v in moved
    ]
    seen = [
        dataclasses.replace(v, pixel=type(v.pixel)(*p.pixels[0])) for v, p in zip(moved, pixels, strict=True)
    ]
    job = paper(seen, Cell(1.0, 2, 1.0, 0.01))
    np.testing.assert_allclose(job.read(job.run()).target, truth, rtol=1e-9)


def test_covariance_of_a_point_is_carried_to_bearing_and_inverse_depth():
    random = np.random.default_rng(5)
    spread = 1e-6 * np.diag([1.0, 2.0, 5.0])
    points = random.multivariate_normal([0.2, -0.1, 2.0], spread, 50_000)
    answer = from_point(np.array([0.2, -0.1, 2.0]), spread)
    sampled = np.cov(np.column_stack([points[:, :2] / points[:, 2:], 1.0 / points[:, 2]]).T)
    np.testing.assert_allclose(answer.covariance, sampled, atol=0.03 * np.abs(sampled).max())


def test_point_behind_is_no_answer():
    assert from_point(np.array([0.0, 0.0, -1.0])) is None
    assert OdometryNoise.per_step(0.02) == Cell(1.0, 2, 1.0, 0.02).noise
