"""What is refused as too high is too high, and what can be reached is not refused for it."""

import asyncio
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import binom

from tapreach.estimation.point_estimate import Status
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.ray import Ray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.candidate_moves import NEAREST
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.looking import _not_located, _within_reach_up_to, look
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.preview import preview
from tapreach.tasks.fetch.reach import Verdict, highest_grip
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome, Phase, next_phase
from tapreach.tasks.fetch.thing import NoSize, Thing
from tapreach.tasks.fetch.too_high import (
    WORTH_SAYING,
    refused_by_place,
    refused_by_sight,
    refused_unlocated,
    tap_within_reach_up_to,
    within_reach_up_to,
)
from tapreach.tasks.task import Tap
from tasks.fetch.worlds import BODY, ROBOT, size_at
from tasks.rig import bare_context

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


def with_camera(up: float, pitch_deg: float) -> RobotDescription:
    mount = ROBOT.camera.mount.model_copy(update={"up": up, "pitch_deg": pitch_deg})
    return ROBOT.model_copy(update={"camera": ROBOT.camera.model_copy(update={"mount": mount})})


def run_of(description: RobotDescription, tap: Tap) -> FetchRun:
    """A fetch without a robot: whatever would move fails."""
    context = replace(bare_context(), description=description)
    return FetchRun(context, FetchMemory(tap, 1, Mode.GO), [], ArmWatch.__new__(ArmWatch))


def test_look_refuses_before_anything_moves() -> None:
    run = run_of(with_camera(up=0.4, pitch_deg=-20.0), Tap(1, 320.0, 100.0))
    ended = asyncio.run(look(run))
    assert ended.outcome is Outcome.CANNOT
    assert next_phase(Phase.LOOK, ended.outcome, 1) is Phase.REFUSED
    assert "too high" in ended.why


def test_box_that_reaches_down_to_the_claw_is_not_refused_for_its_upper_edge() -> None:
    description = with_camera(up=0.4, pitch_deg=0.0)
    box = PixelBox(300.0, 40.0, 340.0, 470.0)
    upper, whole = (run_of(description, Tap(1, 320.0, 60.0, each)) for each in (None, box))
    assert asyncio.run(_within_reach_up_to(upper, upper.memory.tap)) == 0.0
    assert math.isinf(asyncio.run(_within_reach_up_to(whole, whole.memory.tap)))


@pytest.mark.parametrize("status", [Status.RANGE_BOUNDED_BELOW, Status.DETERMINED])
def test_look_in_vain_is_refused_where_it_is_surely_farther_than_it_may_be(status: Status) -> None:
    lost = Ended(Outcome.LOST, "it has left the picture")
    estimate = SimpleNamespace(status=status, range_interval_95=(1.4, None))
    assert _not_located(lost, 1.2, estimate).outcome is Outcome.CANNOT  # type: ignore[arg-type]
    assert _not_located(lost, 1.5, estimate) is lost  # type: ignore[arg-type]


def test_look_in_vain_is_refused_only_where_the_line_of_sight_rises() -> None:
    lost = Ended(Outcome.LOST, "it has left the picture")
    assert _not_located(lost, 0.7, None).outcome is Outcome.CANNOT
    assert _not_located(lost, math.inf, None) is lost
    assert _not_located(lost, WORTH_SAYING + 0.1, None) is lost


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


def test_outline_of_a_thing_on_something_is_no_tall_thing_that_stands_on_the_floor() -> None:
    """Nobody drew it: a can on a crate of its colour looks like one upright thing."""
    outline = replace(size_at(1.0, 0.0, width=0.05, height=0.49), by_picture=True, told=2)
    found = preview(Thing(np.array([1.0, 0.0, 0.45]), 1e-4 * np.eye(3), outline), [], PlanarPose(), ROBOT)
    assert found.verdict is Verdict.NO
    assert found.reason.startswith("too high") and "tap it lower down" in found.advice
