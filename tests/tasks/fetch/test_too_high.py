"""What is refused as too high is too high, and what can be reached is not refused for it."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import binom

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.ray import Ray
from tapreach.tasks.candidate_moves import NEAREST
from tapreach.tasks.fetch.preview import preview
from tapreach.tasks.fetch.reach import Verdict, highest_grip
from tapreach.tasks.fetch.thing import NoSize, Thing
from tapreach.tasks.fetch.too_high import (
    refused_by_place,
    refused_by_sight,
    refused_unlocated,
    tap_within_reach_up_to,
    within_reach_up_to,
)
from tasks.fetch.worlds import BODY, ROBOT, size_at

HIGHEST = highest_grip(0.0, BODY.claw)
assert HIGHEST is not None
TILT, UP = math.radians(0.58), 0.003


def seen_by_a_wrong_mount(point, camera_up: float, rng: np.random.Generator) -> tuple[Ray, float]:
    """Return the line of sight to a point as the robot file has it, and how far the point truly is."""
    camera = np.array([0.0, 0.0, camera_up])
    turned = Rotation.from_rotvec(TILT * rng.standard_normal(3))
    told_up = camera_up + UP * rng.standard_normal()
    return Ray(np.array([0.0, 0.0, told_up]), turned.apply(point - camera)), float(
        np.linalg.norm(point - camera)
    )


@pytest.mark.parametrize("camera_up", [0.1, 0.15, 0.27])
def test_what_can_be_reached_is_taken_for_too_high_once_in_a_hundred_at_most(camera_up) -> None:
    rng, runs = np.random.default_rng(4), 3000
    wrong = 0
    for _ in range(runs):
        distance, bearing = rng.uniform(NEAREST, 3.0), rng.uniform(-0.5, 0.5)
        height = HIGHEST - rng.exponential(0.01)
        point = np.array([distance * math.cos(bearing), distance * math.sin(bearing), height])
        ray, away = seen_by_a_wrong_mount(point, camera_up, rng)
        wrong += away > within_reach_up_to(ray, HIGHEST, TILT, UP)
    assert wrong <= binom.ppf(0.9999, runs, 0.01), "worse than stated"


def test_bound_is_not_idle() -> None:
    """What is high above the claw is told from afar, whichever way the mount is off."""
    rng = np.random.default_rng(5)
    for _ in range(300):
        point = np.array([rng.uniform(1.0, 2.0), rng.uniform(-0.3, 0.3), HIGHEST + 0.3])
        ray, away = seen_by_a_wrong_mount(point, 0.15, rng)
        assert within_reach_up_to(ray, HIGHEST, TILT, UP) < away


@pytest.mark.parametrize("rise", [0.0, -0.3, math.tan(TILT)])
def test_line_of_sight_that_may_be_level_never_rises_above_the_claw(rise) -> None:
    ray = Ray(np.array([0.0, 0.0, 0.15]), np.array([1.0, 0.0, rise]))
    assert math.isinf(within_reach_up_to(ray, HIGHEST, TILT, UP))
    assert refused_by_sight(math.inf) == refused_unlocated(math.inf) == ""


def test_camera_above_the_reach_that_looks_up_sees_nothing_to_fetch() -> None:
    ray = Ray(np.array([0.0, 0.0, HIGHEST + 0.1]), np.array([1.0, 0.0, 0.2]))
    within = within_reach_up_to(ray, HIGHEST, TILT, UP)
    assert within == 0.0
    assert refused_by_sight(within).startswith("too high: however near")


def test_upper_edge_of_the_picture_is_within_reach_only_near() -> None:
    upper, middle = (tap_within_reach_up_to(Pixel(320.0, v), ROBOT) for v in (2.0, 240.0))
    assert NEAREST < upper < 1.0
    assert math.isinf(middle)
    assert refused_by_sight(upper) == "", "it may be near"
    assert "unless it is nearer than" in refused_unlocated(upper)
    assert refused_unlocated(upper, at_least=1.2).startswith("too high: however near")


def test_place_is_too_high_only_with_two_sigmas_to_spare() -> None:
    at = [np.array([1.0, 0.0, HIGHEST + over]) for over in (0.03, 0.05)]
    cov = np.diag([0.1, 0.1, 0.02**2])
    assert refused_by_place(at[0], cov, BODY.claw) is None
    refused = refused_by_place(at[1], cov, BODY.claw)
    assert refused is not None and refused.verdict is Verdict.NO
    assert "too high: the claw reaches 281 mm, it was tapped 331 mm above the floor" in refused.reason


@pytest.mark.parametrize("size", [NoSize("nothing bounds it"), size_at(1.0, 0.0, width=0.24, height=0.5)])
def test_what_stands_high_on_something_is_not_called_too_wide(size) -> None:
    point = np.array([1.0, 0.0, 0.45])
    found = preview(Thing(point, 1e-4 * np.eye(3), size), [], PlanarPose(), ROBOT)
    assert found.verdict is Verdict.NO
    assert "too high" in found.reason


def test_tall_thing_that_the_claw_can_grip_lower_down_is_fetched() -> None:
    vase = size_at(1.0, 0.0, width=0.05, height=0.4)
    found = preview(Thing(np.array([1.0, 0.0, 0.38]), 1e-4 * np.eye(3), vase), [], PlanarPose(), ROBOT)
    assert found.verdict is Verdict.YES
