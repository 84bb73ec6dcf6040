"""What widths from several sides tell of an outline: a box is told from a round thing, and its best side."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.estimation.footprint import SeenWidth, footprint

OPENING = 0.073
angles = st.floats(-math.pi, math.pi)


def width_of_box(a: float, b: float, heading: float, along: float) -> float:
    return a * abs(math.sin(along - heading)) + b * abs(math.cos(along - heading))


def seen_box(
    a: float, b: float, heading: float, alongs: list[float], sd: float = 0.003
) -> tuple[SeenWidth, ...]:
    return tuple(SeenWidth(along, width_of_box(a, b, heading, along), sd) for along in alongs)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.03, 0.12), st.floats(0.7, 1.4), angles)
def test_box_seen_from_all_around_is_known_from_every_side(a: float, ratio: float, heading: float) -> None:
    told = footprint(seen_box(a, ratio * a, heading, list(np.radians(np.arange(0, 180, 22.5)))))
    for along in np.radians(np.arange(0, 180, 10.0)):
        width, sd = told.width(float(along))
        off = abs(width - width_of_box(a, ratio * a, heading, float(along)))
        assert off <= 3.0 * sd + 0.06 * width


@settings(max_examples=25, deadline=None)
@given(angles, angles)
def test_square_box_over_its_corner_fits_best_from_its_side(heading: float, begin: float) -> None:
    """Seen from five sides; a claw of 73 mm takes 58 mm, and not the 82 mm over the corner."""
    told = footprint(seen_box(0.058, 0.058, heading, [begin + k * 0.6 for k in range(5)]))
    side, corner = heading, heading + math.pi / 4.0
    assert told.fits(side, OPENING) > 0.75 > 0.3 > told.fits(corner, OPENING)
    assert told.best_fit(OPENING) >= told.fits(side, OPENING) - 0.1


@settings(max_examples=25, deadline=None)
@given(st.floats(0.1, 0.3), angles)
def test_what_is_too_wide_from_several_sides_has_no_side_that_fits(width: float, begin: float) -> None:
    seen = tuple(SeenWidth(begin + off, width, 0.004) for off in (0.0, 0.5, 1.0))
    assert footprint(seen).best_fit(OPENING) < 0.05


@given(st.floats(0.03, 0.2), st.floats(0.002, 0.01), angles, angles)
@settings(max_examples=25, deadline=None)
def test_chances_turn_with_the_thing(width: float, sd: float, along: float, turn: float) -> None:
    here, there = footprint((SeenWidth(along, width, sd),)), footprint((SeenWidth(along + turn, width, sd),))
    for aside in (0.0, 0.4, 0.8):
        both = (each.fits(at + aside, OPENING) for each, at in ((here, along), (there, along + turn)))
        assert next(both) == pytest.approx(next(both), abs=0.06)


def test_same_width_again_from_the_same_side_makes_it_no_surer() -> None:
    once = SeenWidth(0.3, 0.07, 0.004)
    alone, often = footprint((once,)), footprint((once,) * 5)
    assert often.fits(0.3, OPENING) == pytest.approx(alone.fits(0.3, OPENING), abs=1e-9)


def test_opposite_sides_are_the_same_side() -> None:
    one, other = (footprint((SeenWidth(along, 0.07, 0.004),)) for along in (0.3, 0.3 + math.pi))
    assert one.fits(0.9, OPENING) == pytest.approx(other.fits(0.9, OPENING), abs=1e-9)


def test_one_width_that_takes_in_what_stands_behind_is_outvoted() -> None:
    seen = [SeenWidth(along, 0.06, 0.003) for along in (0.0, 0.3, 0.9, 1.2)]
    told = footprint((*seen, SeenWidth(0.6, 0.3, 0.005)))
    assert told.fits(0.6, OPENING) > 0.8


def test_direction_that_was_not_seen_is_known_worse() -> None:
    told = footprint((SeenWidth(0.0, 0.06, 0.002),))
    (near, near_sd), (_, far_sd) = told.width(0.0), told.width(math.pi / 4.0)
    assert near == pytest.approx(0.06, abs=0.003) and near_sd < 0.5 * far_sd
    assert told.fits(0.0, OPENING) > told.fits(math.pi / 4.0, OPENING)


def test_without_any_width_nothing_is_preferred() -> None:
    anything = footprint(())
    chances = [anything.fits(along, OPENING) for along in (0.0, 0.5, 1.0)]
    assert max(chances) - min(chances) < 0.02
    assert float(anything.odds.sum()) == pytest.approx(1.0)
