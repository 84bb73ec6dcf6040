"""Taps in the browser, and what counts as inside the picture."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize, Pixel, pixel_from_browser, require_inside

VGA = ImageSize(640, 480)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(50.0, 4000.0), st.floats(50.0, 4000.0))
def test_tap_on_the_shown_picture_is_inside_whatever_its_size(across, down, width, height):
    pixel = pixel_from_browser(17 + across * width, 5 + down * height, 17, 5, width, height, VGA)
    assert pixel.u == pytest.approx(across * 640 - 0.5, abs=1e-6)
    assert pixel.v == pytest.approx(down * 480 - 0.5, abs=1e-6)


def test_tap_in_the_middle_of_the_first_shown_pixel_is_pixel_zero():
    assert pixel_from_browser(12.0, 22.0, 10.0, 20.0, 2560, 1920, VGA) == Pixel(0.0, 0.0)


def test_tap_outside_the_picture_is_refused_with_the_limits():
    with pytest.raises(InputError, match=r"\(640\.0, 10\.0\) lies outside.*639\.5"):
        require_inside(Pixel(640.0, 10.0), VGA)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "left", None])
def test_pixel_that_is_no_number_is_refused(bad):
    with pytest.raises(InputError, match="pixel u"):
        Pixel(bad, 1.0)


@pytest.mark.parametrize("shown", [0.0, -1.0, float("nan")])
def test_picture_shown_without_width_is_refused(shown):
    with pytest.raises(InputError, match="shown_width"):
        pixel_from_browser(1.0, 1.0, 0.0, 0.0, shown, 100.0, VGA)


@pytest.mark.parametrize("width", [0, -1, 1.5, float("nan")])
def test_image_size_that_cannot_be_is_refused(width):
    with pytest.raises(InputError, match="image width"):
        ImageSize(width, 480)
