"""What a place known from an earlier look adds to a new one, and when it adds nothing."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.estimation.point_estimate import Status
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.estimating import LocatedPoint, estimate
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.optics import optics_of, points_in_camera
from tapreach.tasks.sighting import Sighting
from tasks.rig import sim_description

ROBOT = sim_description()
THING = np.array([0.62, 0.05, 0.05])
START = PlanarPose(0.05, 0.02, 0.05)


def seen_from(poses: list[PlanarPose], thing: np.ndarray = THING, noise: np.ndarray | None = None):
    sightings = []
    for index, pose in enumerate(poses):
        in_camera = points_in_camera(thing[None], pose, ROBOT.camera)
        u, v = optics_of(ROBOT.camera)[0].project(in_camera).pixels[0]
        if noise is not None:
            u, v = (u, v) + noise[index]
        sightings.append(Sighting(index, index, Pixel(float(u), float(v)), 0.4, 1.0, pose))
    return sightings


def known(sd: float = 0.01, off: tuple[float, float] = (0.0, 0.0), at: PlanarPose = START) -> KnownPlace:
    return KnownPlace(THING + np.array([*off, 0.0]), sd**2 * np.eye(3), at)


def way_sd(found: LocatedPoint) -> float:
    assert found.point_cov_in_world is not None
    return math.sqrt(float(np.linalg.eigvalsh(found.point_cov_in_world)[-1]))


def test_one_view_and_a_place_known_before_are_a_position() -> None:
    found = estimate(seen_from([START]), ROBOT, False, known=known(0.01))
    assert found.status is Status.DETERMINED and found.point_in_world is not None
    np.testing.assert_allclose(found.point_in_world, THING, atol=1e-6)
    assert found.relative_sd * 0.5 == pytest.approx(0.01, rel=0.4)
    assert found.range_interval_95 is not None and found.range is not None
    low, high = found.range_interval_95
    assert high is not None and low < found.range < high


@given(st.floats(0.003, 0.03), st.floats(0.01, 0.06))
def test_what_was_known_makes_few_views_surer_and_never_less_sure(sd: float, advance: float) -> None:
    views = seen_from([START, START.after(PlanarStep(0.0, advance))])
    alone, with_known = (estimate(views, ROBOT, False, known=each) for each in (None, known(sd)))
    assert with_known.status is Status.DETERMINED
    assert with_known.relative_sd <= alone.relative_sd * 1.001
    assert way_sd(with_known) < 1.5 * sd + 0.02


def test_region_of_place_and_views_together_holds_the_truth_as_often_as_it_says() -> None:
    rng = np.random.default_rng(11)
    poses = [START, START.after(PlanarStep(0.0, 0.04)), START.after(PlanarStep(0.1, 0.08))]
    normed = []
    for _ in range(150):
        was = KnownPlace(THING + rng.normal(size=3) * 0.02, 0.02**2 * np.eye(3), poses[-1])
        found = estimate(seen_from(poses, noise=rng.normal(size=(3, 2)) * 0.4), ROBOT, False, known=was)
        assert found.range is not None
        truth = float(np.linalg.norm(THING - camera_of(found.sightings[0])))
        normed.append((found.range - truth) / (found.relative_sd * found.range))
    assert np.mean(np.square(normed)) < 1.3
    assert np.mean(np.abs(normed) < 1.96) > 0.9


def camera_of(sighting: Sighting) -> np.ndarray:
    return (sighting.world_from_base.to_rigid() * ROBOT.camera.mount.base_from_camera()).translation


@pytest.mark.parametrize("off", [(0.0, 0.25), (0.4, 0.0)])
def test_what_is_seen_somewhere_else_is_not_what_was_known(off: tuple[float, float]) -> None:
    views = seen_from([START, START.after(PlanarStep(0.0, 0.15)), START.after(PlanarStep(0.0, 0.25))])
    alone = estimate(views, ROBOT, False)
    other = estimate(views, ROBOT, False, known=known(0.01, off))
    assert (other.relative_sd, other.range) == (alone.relative_sd, alone.range)


def test_single_view_of_something_else_stays_without_a_position() -> None:
    found = estimate(seen_from([START]), ROBOT, False, known=known(0.005, (0.0, 0.2)))
    assert found.status is Status.DEGENERATE and found.point_in_world is None


def test_thing_that_was_pushed_is_found_where_it_is_now() -> None:
    pushed = THING + np.array([0.03, 0.02, 0.0])
    views = seen_from([START, START.after(PlanarStep(0.0, 0.15)), START.after(PlanarStep(0.0, 0.25))], pushed)
    found = estimate(views, ROBOT, False, known=known(0.005).perhaps_moved(0.03, 0.01))
    assert found.point_in_world is not None
    off = found.point_in_world - pushed
    assert off @ np.linalg.solve(found.point_cov_in_world, off) < 12.0
    assert np.linalg.norm(off[:2]) < 0.02


@given(st.floats(0.05, 1.0), st.floats(-1.0, 1.0))
def test_place_is_known_less_well_the_farther_is_driven(advance: float, turn: float) -> None:
    was = known(0.01)
    half = START.after(PlanarStep(turn / 2.0, advance / 2.0))
    sds = [
        np.trace(was.seen_from(here, ROBOT).cov_in_world)
        for here in (START, half, half.after(PlanarStep(turn / 2.0, advance / 2.0)))
    ]
    assert sds[0] == pytest.approx(3e-4) and sds[0] < sds[1]
    there_and_back = was.seen_from(half, ROBOT).seen_from(START, ROBOT)
    assert np.trace(there_and_back.cov_in_world) > sds[1]


def test_views_that_contradict_each_other_are_not_mended_by_what_was_known() -> None:
    views = seen_from([START, START.after(PlanarStep(0.0, 0.1)), START.after(PlanarStep(0.0, 0.2))])
    views[1] = replace(views[1], pixel=Pixel(views[1].pixel.u, views[1].pixel.v - 60.0))
    views[2] = replace(views[2], pixel=Pixel(views[2].pixel.u, views[2].pixel.v + 60.0))
    alone, both = (estimate(views, ROBOT, False, known=each) for each in (None, known(0.01)))
    assert alone.status is both.status is Status.INCONSISTENT


def test_distance_that_was_wrong_is_put_right_by_the_new_views() -> None:
    """The claw closed on nothing: the thing never was where it was thought to be, and so surely."""
    wrong = THING - np.array([0.06, 0.0, 0.0])
    views = seen_from([START, START.after(PlanarStep(0.0, 0.15)), START.after(PlanarStep(0.0, 0.25))], THING)
    sure = known(0.005)
    mistaken = replace(sure, point_in_world=wrong).perhaps_along(0.0, 0.08)
    np.testing.assert_allclose(mistaken.cov_in_world[1:, 1:], sure.cov_in_world[1:, 1:])
    found = estimate(views, ROBOT, False, known=mistaken)
    assert found.point_in_world is not None
    assert np.linalg.norm((found.point_in_world - THING)[:2]) < 0.02
