"""A size that was measured once is kept, and made surer by a second one only as far as both say the same."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.kept_size import SizeDoubt, contradicts, with_earlier
from tapreach.tasks.fetch.thing import NoSize
from tasks.fetch.worlds import size_at

widths = st.floats(0.03, 0.07)
sds = st.floats(0.001, 0.01)


@given(widths, sds, sds, st.floats(-1.0, 1.0), st.floats(-0.2, 0.2))
def test_mean_of_two_sizes_lies_between_them_and_is_no_surer_than_the_better(
    width: float, sd: float, earlier_sd: float, off: float, aside: float
) -> None:
    new = size_at(0.5, 0.0, width, width_sd=sd)
    earlier = replace(size_at(0.5, 0.0, width + off * earlier_sd, width_sd=earlier_sd), seen_along=aside)
    both = with_earlier(new, earlier, 0.0)
    low, high = sorted((new.width, earlier.width))
    assert low - 1e-12 <= both.width <= high + 1e-12
    assert min(sd, earlier_sd) - 1e-12 <= both.width_sd <= max(sd, earlier_sd) + 1e-12
    by_new, by_earlier = abs(both.width - new.width), abs(both.width - earlier.width)
    assert by_new <= by_earlier + 1e-12 or earlier_sd < sd


def test_width_from_another_side_is_another_width_and_the_height_is_the_same() -> None:
    new = size_at(0.5, 0.0, 0.05, 0.100, width_sd=0.003, height_sd=0.004)
    earlier = replace(size_at(0.5, 0.0, 0.053, 0.102, height_sd=0.004), seen_along=math.radians(40.0))
    both = with_earlier(new, earlier, 0.0)
    assert (both.width, both.width_sd) == (new.width, new.width_sd)
    assert both.height == pytest.approx(0.101)


def test_size_of_something_else_does_not_count() -> None:
    new, other = size_at(0.5, 0.0, 0.04), replace(size_at(0.5, 0.0, 0.06), seen_along=0.0)
    assert with_earlier(new, other, 0.0) is new
    assert with_earlier(new, None, 0.0) is new


@given(widths, sds, st.floats(-2.9, 2.9))
def test_sizes_that_differ_by_chance_do_not_contradict(width: float, sd: float, sigmas: float) -> None:
    current = replace(size_at(0.5, 0.0, width, width_sd=sd), seen_along=0.1)
    new = size_at(0.5, 0.0, width + sigmas * math.sqrt(2.0) * sd, width_sd=sd)
    assert not contradicts(new, current, 0.0)


def test_what_takes_in_the_crate_behind_contradicts_unless_it_is_seen_from_another_side() -> None:
    cup = replace(size_at(0.5, 0.0, 0.06, 0.08), seen_along=0.0)
    both = size_at(0.5, 0.0, 0.3, 0.34)
    assert contradicts(both, cup, 0.0)
    assert not contradicts(both, cup, math.radians(40.0))


def test_size_against_the_known_one_is_believed_when_it_is_measured_again_from_elsewhere() -> None:
    cup = replace(size_at(0.5, 0.0, 0.06, 0.08), seen_along=0.0)
    both, doubt = size_at(0.5, 0.0, 0.3, 0.34), SizeDoubt()
    assert doubt.believed(both, cup, PlanarPose(), 0.0) is None
    assert doubt.believed(both, cup, PlanarPose(0.02), 0.0) is None
    assert doubt.believed(both, cup, PlanarPose(0.3), 0.0) == replace(both, told=2)


def test_size_that_agrees_again_ends_the_doubt() -> None:
    cup = replace(size_at(0.5, 0.0, 0.06, 0.08), seen_along=0.0)
    both, doubt = size_at(0.5, 0.0, 0.3, 0.34), SizeDoubt()
    doubt.believed(both, cup, PlanarPose(), 0.0)
    again = doubt.believed(cup, cup, PlanarPose(0.2), 0.0)
    assert again is not None and again.width == cup.width
    assert doubt.believed(both, cup, PlanarPose(0.4), 0.0) is None


def test_single_views_count_when_two_from_different_places_tell_the_same() -> None:
    unknown, doubt = NoSize("not measured"), SizeDoubt()
    alone, same, other = (NoSize("one view", size_at(0.5, 0.0, width)) for width in (0.05, 0.051, 0.3))
    assert doubt.believed(alone, unknown, PlanarPose(), 0.0) is None
    assert doubt.believed(other, unknown, PlanarPose(0.2), 0.0) is None
    assert doubt.believed(alone, unknown, PlanarPose(0.4), 0.0) is None
    believed = doubt.believed(same, unknown, PlanarPose(0.6), 0.0)
    assert believed is not None and (believed.width, believed.told) == (0.051, 2)


def test_size_is_told_once_more_by_each_measurement_from_elsewhere_that_agrees() -> None:
    size, doubt = size_at(0.5, 0.0, 0.15), SizeDoubt()
    current, told = NoSize("not measured"), []
    for x in (0.0, 0.02, 0.2, 0.22, 0.5):
        current = doubt.believed(size, current, PlanarPose(x), 0.0)
        assert current is not None
        told.append(current.told)
    assert told == [1, 1, 2, 2, 3]


def test_outline_with_an_end_in_doubt_does_not_replace_a_width_that_is_known() -> None:
    """It agrees only because it says so little."""
    cup = replace(size_at(0.5, 0.0, 0.059, 0.11, width_sd=0.005), seen_along=0.0, told=3)
    blurred = size_at(0.5, 0.0, 0.264, 0.12, width_sd=0.09)
    assert not contradicts(blurred, cup, 0.0)
    assert SizeDoubt().believed(blurred, cup, PlanarPose(), 0.0) is None
    from_aside = SizeDoubt().believed(blurred, cup, PlanarPose(), math.radians(40.0))
    assert from_aside is not None and from_aside.width == blurred.width


@pytest.mark.parametrize(
    ("x", "width", "is_settled"), [(0.2, 0.061, True), (0.01, 0.061, False), (0.2, 0.25, False)]
)
def test_size_against_the_known_one_is_believed_when_one_view_from_elsewhere_tells_the_same(
    x: float, width: float, is_settled: bool
) -> None:
    both = replace(size_at(0.5, 0.0, 0.13), seen_along=0.0)
    cup, doubt = size_at(0.5, 0.0, 0.06), SizeDoubt()
    assert doubt.believed(cup, both, PlanarPose(), 0.0) is None
    one_view = NoSize("only one view shows it", size_at(0.5, 0.0, width))
    believed = doubt.believed(one_view, both, PlanarPose(x), 0.0)
    assert (believed == replace(cup, told=2)) == is_settled
    assert (doubt.against is None) == is_settled


def test_height_up_to_the_end_of_the_picture_is_a_lower_limit() -> None:
    """From near the picture ends below the top of what from far was seen whole."""
    post = replace(size_at(0.5, 0.0, 0.05, 0.36), seen_along=0.0)
    cut = replace(size_at(0.5, 0.0, 0.05, 0.25), is_cut_above=True)
    believed = SizeDoubt().believed(cut, post, PlanarPose(), 0.0)
    assert believed is not None and (believed.height, believed.height_sd) == (post.height, post.height_sd)
    assert believed.axis_in_world[2] == pytest.approx(0.18) and not believed.is_cut_above
    higher = replace(size_at(0.5, 0.0, 0.05, 0.37), is_cut_above=True)
    assert higher.at_least_as_high_as(post) is higher
    whole = size_at(0.5, 0.0, 0.05, 0.25)
    assert SizeDoubt().believed(whole, post, PlanarPose(), 0.0) is None
