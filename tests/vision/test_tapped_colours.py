"""What was tapped from far is told by its colours from near, whatever stands beside it."""

import cv2
import numpy as np
import pytest

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.tapped_colours import colours_around, common_with

RED, WHITE, GREEN, BLUE = (30, 30, 190), (225, 225, 225), (60, 150, 40), (170, 80, 40)
NEAR = PixelBox(260.0, 100.0, 380.0, 340.0)


def near(*stripes: tuple[int, int, int]) -> np.ndarray:
    """A thing with level stripes, from near."""
    picture = np.full((480, 640, 3), 120, np.uint8)
    edges = np.linspace(NEAR.top, NEAR.bottom, len(stripes) + 1).astype(int)
    for colour, top, bottom in zip(stripes, edges[:-1], edges[1:], strict=True):
        picture[top:bottom, int(NEAR.left) : int(NEAR.right)] = colour
    return picture


def from_far(picture: np.ndarray, scale: float, light: float = 1.0) -> np.ndarray:
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.clip(light * small, 0, 255).astype(np.uint8)


def tapped(picture: np.ndarray, scale: float, half: float = 3.0) -> np.ndarray:
    middle = NEAR.middle
    return colours_around(picture, Pixel(scale * middle.u, scale * middle.v), half)


@pytest.mark.parametrize("scale", [1.0, 0.5, 0.2])
@pytest.mark.parametrize("light", [0.85, 1.0, 1.1])
def test_thing_has_the_colours_of_the_spot_tapped_and_another_has_not(scale: float, light: float) -> None:
    seen = near(RED, WHITE, RED, WHITE, RED)
    colours = tapped(from_far(seen, scale, light), scale)
    assert common_with(seen, NEAR, scale, colours) > 0.45
    for other in (near(GREEN), near(BLUE, GREEN, BLUE)):
        assert common_with(other, NEAR, scale, colours) < 0.3


def test_stripes_too_fine_to_be_told_apart_from_far_are_seen_as_small_before_they_are_compared() -> None:
    fine = near(*[RED, WHITE] * 30)
    colours = tapped(from_far(fine, 0.1), 0.1)
    assert common_with(fine, NEAR, 0.1, colours) > 0.6 > common_with(fine, NEAR, 1.0, colours)


def test_thing_has_most_in_common_with_itself_and_nothing_with_what_has_none_of_its_colours() -> None:
    colours = colours_around(near(RED), NEAR.middle, 20.0)
    assert 0.9 < common_with(near(RED), NEAR, 1.0, colours) <= 1.0
    assert common_with(near(GREEN), NEAR, 1.0, colours) < 0.01
