"""The colours of a thing are learned where it was tapped, and it is tapped where they are seen next."""

import asyncio
import math
from dataclasses import replace

import numpy as np
import pytest

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.messages import Frame
from tapreach.tasks.fetch.by_colours import is_of_its_colours, tap_by_colours
from tapreach.tasks.fetch.expected_box import expected_box
from tapreach.tasks.fetch.run import FetchRun
from tapreach.tasks.task import Tap
from tasks.fetch.looks import GREEN, HERE, MIDDLE, RED, frame, pixel_of, run_after_look
from tasks.fetch.worlds import ROBOT, size_at


def tapped(run: FetchRun, seen: Frame, here: PlanarPose = HERE) -> Tap | None:
    return asyncio.run(tap_by_colours(run, seen, here))


def test_thing_is_tapped_where_its_colours_are_and_known_there_from_then_on() -> None:
    run = run_after_look((RED, RED, RED))
    moved = MIDDLE + np.array([0.0, 0.04, 0.0])
    tap = tapped(run, frame(moved, RED))
    assert tap is not None
    assert abs(tap.u - pixel_of(moved)[0]) < 15.0 and abs(tap.v - pixel_of(moved)[1]) < 25.0
    known = run.memory.known
    assert known is not None
    np.testing.assert_allclose(pixel_of(known.place.point_in_world), (tap.u, tap.v), atol=0.01)
    np.testing.assert_allclose(known.middle[:2], moved[:2], atol=0.012)


def test_thing_measured_together_with_what_stands_beside_it_is_found_and_its_size_forgotten() -> None:
    run = run_after_look((RED, RED, RED))
    assert run.memory.known is not None
    wide = replace(size_at(0.6, 0.03, width=0.25, height=0.25), seen_along=0.0)
    run.remember(known=replace(run.memory.known, size=wide, axis_offset=np.array([0.1, 0.1, 0.1])))
    tap = tapped(run, frame(MIDDLE, RED, half=(0.03, 0.03)))
    assert tap is not None and abs(tap.u - pixel_of(MIDDLE)[0]) < 15.0
    assert run.memory.known.size is None and run.memory.known.axis_offset is None


def test_thing_farther_off_than_it_should_be_is_found_only_by_most_of_its_colours() -> None:
    run = run_after_look((RED, RED, RED))
    assert run.memory.known is not None
    place = replace(run.memory.known.place, cov_in_world=0.004**2 * np.eye(3))
    run.remember(known=replace(run.memory.known, place=place))
    bumped = MIDDLE + np.array([0.0, 0.05, 0.0])
    there = expected_box(run.memory.known, HERE, ROBOT)
    assert (
        there is not None and abs(there.pixel[0] - pixel_of(bumped)[0]) > 3.5 * there.covariance[0, 0] ** 0.5
    )
    assert tapped(run, frame(bumped, (60, 60, 150))) is None
    tap = tapped(run, frame(bumped, RED))
    assert tap is not None and abs(tap.u - pixel_of(bumped)[0]) < 15.0


def test_thing_of_which_hardly_the_place_is_known_is_not_sought_farther_off_still() -> None:
    run = run_after_look((RED, RED, RED))
    assert run.memory.known is not None
    unsure = replace(run.memory.known.place, cov_in_world=np.diag([0.1, 0.004, 0.004]) ** 2)
    run.remember(known=replace(run.memory.known, place=unsure))
    assert tapped(run, frame(MIDDLE + np.array([0.0, 0.05, 0.0]), RED)) is None


@pytest.mark.parametrize("seen", [frame(MIDDLE, GREEN), Frame(0, 0, 0, ROBOT.camera.model().size, b"")])
def test_thing_of_another_colour_or_in_a_broken_picture_is_not_tapped(seen: Frame) -> None:
    run = run_after_look((RED, RED, RED))
    before = run.memory.known
    assert tapped(run, seen) is None
    assert run.memory.known is before


def test_thing_that_would_be_out_of_the_picture_is_not_sought() -> None:
    run = run_after_look((RED, RED, RED))
    assert run.memory.known is not None
    away = replace(HERE, heading=math.pi)
    assert expected_box(run.memory.known, away, ROBOT) is None
    assert tapped(run, frame(MIDDLE, RED), away) is None


def test_colours_are_those_that_were_tapped_not_those_of_what_is_followed_by_mistake() -> None:
    run = run_after_look((RED, RED, GREEN))
    assert tapped(run, frame(MIDDLE, GREEN)) is None
    assert tapped(run, frame(MIDDLE, RED)) is not None


def test_what_is_doubtful_by_now_has_still_told_its_colours_where_it_was_tapped() -> None:
    assert tapped(run_after_look((RED, RED, RED), "it looks alike at several distances"), frame(MIDDLE, RED))


def test_spot_is_judged_by_the_colours_around_it_and_passes_while_none_are_known() -> None:
    run, spot = run_after_look((RED, RED, RED)), Pixel(*map(float, pixel_of(MIDDLE)))
    assert asyncio.run(is_of_its_colours(run, frame(MIDDLE, RED), spot, HERE))
    assert not asyncio.run(is_of_its_colours(run, frame(MIDDLE, GREEN), spot, HERE))
    run.remember(known=replace(run.memory.known, colours=None))
    assert asyncio.run(is_of_its_colours(run, frame(MIDDLE, GREEN), spot, HERE))
    assert tapped(run, frame(MIDDLE, RED)) is None
