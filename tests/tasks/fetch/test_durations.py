"""Expected times against the controller itself, on wheels that do what they are told."""

import math

import pytest

from tapreach.control.motion import Progress
from tapreach.control.relative_move import advance_profile, slowed, turn_profile
from tapreach.control.slide import Slide, SlideProfile
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS, SECOND
from tapreach.tasks.fetch.durations import slide_seconds, step_seconds
from tasks.fetch.worlds import ROBOT

TICK_NS = 5 * MS


def driven_seconds(way: float, profile: SlideProfile) -> float:
    slide, done, now_ns = Slide(way, profile), 0.0, 0
    while slide.progress is Progress.MOVING:
        done += slide.step(done, now_ns) * TICK_NS / SECOND
        now_ns += TICK_NS
        assert now_ns < 60 * SECOND
    assert slide.progress is Progress.ARRIVED
    return now_ns / SECOND


@pytest.mark.parametrize("way", [0.02, 0.1, -0.3, 1.0, 2.5])
def test_advance_takes_what_the_controller_takes(way):
    profile = advance_profile(ROBOT.base)
    assert slide_seconds(way, profile) == pytest.approx(driven_seconds(way, profile), rel=0.06, abs=0.1)


@pytest.mark.parametrize("angle", [0.05, -0.5, 1.5, math.pi])
def test_turn_takes_what_the_controller_takes(angle):
    profile = turn_profile(ROBOT.base)
    assert slide_seconds(angle, profile) == pytest.approx(driven_seconds(angle, profile), rel=0.06, abs=0.1)


def test_no_way_takes_no_time():
    assert step_seconds(PlanarStep(0.0, 0.0), ROBOT.base) == 0.0


def test_slowed_base_takes_longer():
    step = PlanarStep(0.3, 0.5)
    assert step_seconds(step, slowed(ROBOT.base, 0.5)) > 1.4 * step_seconds(step, ROBOT.base)
