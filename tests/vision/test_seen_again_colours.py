"""A thing is found by its own colours from a side never seen before; what is not there is not found."""

import cv2
import numpy as np
import pytest

from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.own_colours import OwnColours, evidence, has_colours, own_colours
from tapreach.vision.seen_again_colours import ExpectedBox, box_by_colours

SIZE = (360, 480)
RED, YELLOW, GREEN = (30, 30, 190), (40, 200, 220), (60, 150, 40)


def room(seed: int) -> np.ndarray:
    """A grey, mottled floor."""
    noise = cv2.GaussianBlur(np.random.default_rng(seed).normal(size=SIZE).astype(np.float32), (0, 0), 4.0)
    gray = np.clip(125.0 + 25.0 * noise / noise.std(), 0, 255).astype(np.uint8)
    return np.repeat(gray[..., None], 3, axis=2)


def with_can(
    picture: np.ndarray, u: int, v: int, colours: tuple[tuple[int, int, int], ...], half: tuple[int, int]
) -> np.ndarray:
    """The picture with a can whose upright stripes have the colours, from left to right."""
    seen, (across, down) = picture.copy(), half
    edges = np.linspace(u - across, u + across + 1, len(colours) + 1).round().astype(int)
    for colour, left, right in zip(colours, edges[:-1], edges[1:], strict=True):
        seen[v - down : v + down + 1, left:right] = colour
    return seen


def learned(seed: int = 0) -> OwnColours:
    picture = with_can(room(seed), 240, 180, (RED, YELLOW, RED), (15, 25))
    colours = own_colours(picture, PixelBox(225, 155, 255, 205))
    assert colours is not None
    return colours


def around(u: float, v: float, sd: float = 25.0, *scales: float) -> ExpectedBox:
    return ExpectedBox(np.array([u, v]), sd**2 * np.eye(2), 30.0, 50.0, scales or (1.0, 0.8, 1.25))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("stripes", [(YELLOW, RED), (RED,), (YELLOW, RED, YELLOW, RED)])
def test_can_is_found_from_another_side_and_nearer(
    seed: int, stripes: tuple[tuple[int, int, int], ...]
) -> None:
    picture = with_can(room(seed + 5), 275, 155, stripes, (28, 46))
    found = box_by_colours(picture, learned(seed), around(250.0, 180.0))
    assert found is not None
    np.testing.assert_allclose(found.middle.to_array(), [275.0, 155.0], atol=8.0)


def test_can_of_another_colour_and_an_empty_floor_are_not_taken_for_it() -> None:
    other = with_can(room(1), 260, 180, (GREEN,), (30, 50))
    assert box_by_colours(other, learned(), around(250.0, 180.0)) is None
    assert box_by_colours(room(1), learned(), around(250.0, 180.0)) is None


def test_thing_with_only_the_least_of_its_colours_is_another_one() -> None:
    dotted = with_can(room(0), 240, 180, (RED, RED, RED, RED, YELLOW), (15, 25))
    colours = own_colours(dotted, PixelBox(225, 155, 255, 205))
    assert colours is not None
    yellow_and_green = with_can(room(1), 260, 180, (YELLOW, GREEN, YELLOW, YELLOW), (30, 50))
    assert box_by_colours(yellow_and_green, colours, around(250.0, 180.0)) is None
    assert box_by_colours(with_can(room(1), 260, 180, (RED,), (30, 50)), colours, around(250.0, 180.0))


def test_something_larger_of_its_colours_is_not_taken_for_it() -> None:
    wall = room(1)
    wall[40:320, 60:420] = RED
    assert box_by_colours(wall, learned(), around(240.0, 180.0)) is None


def test_of_two_alike_within_reach_neither_is_taken_and_a_far_one_does_not_count() -> None:
    two = with_can(with_can(room(2), 190, 180, (RED,), (30, 50)), 310, 180, (RED,), (30, 50))
    assert box_by_colours(two, learned(), around(250.0, 180.0, 30.0)) is None
    near = box_by_colours(two, learned(), around(190.0, 180.0, 20.0))
    assert near is not None and abs(near.middle.u - 190.0) < 8.0


def test_expected_beside_the_picture_it_is_not_found() -> None:
    assert box_by_colours(room(0), learned(), around(-500.0, 180.0)) is None


def test_what_has_only_the_colours_around_it_has_none_of_its_own() -> None:
    assert own_colours(room(0), PixelBox(225, 155, 255, 205)) is None


def test_colours_of_two_views_are_joined_by_their_pixels() -> None:
    one = learned()
    green = own_colours(with_can(room(1), 240, 180, (GREEN,), (30, 50)), PixelBox(210, 130, 270, 230))
    assert green is not None
    both = one.joined(green)
    assert both.shares.sum() == pytest.approx(1.0)
    picture = with_can(room(3), 240, 180, (GREEN, RED), (15, 25))
    assert evidence(picture, both)[180, 228] > 1.0 and evidence(picture, both)[180, 252] > 1.0
    box = PixelBox(230, 160, 250, 200)
    assert has_colours(picture, both, box) and not has_colours(room(3), both, box)


def test_thing_of_which_most_has_the_colour_of_the_floor_is_found_by_the_rest() -> None:
    """As a white cup with blue dots on a bright floor is."""

    def dotted(u: int, v: int, half: tuple[int, int], noise: int) -> np.ndarray:
        seen = with_can(room(noise), u, v, ((150, 150, 150),), half)
        for x in (-0.6, 0.0, 0.6):
            for y in (-0.6, 0.0, 0.6):
                spot = round(u + x * half[0]), round(v + y * half[1])
                cv2.circle(seen, spot, round(0.28 * half[0]), (150, 60, 40), -1)
        return seen

    colours = own_colours(dotted(240, 180, (15, 25), 0), PixelBox(225, 155, 255, 205))
    assert colours is not None
    found = box_by_colours(dotted(262, 170, (30, 50), 1), colours, around(250.0, 180.0))
    assert found is not None
    np.testing.assert_allclose(found.middle.to_array(), [262.0, 170.0], atol=10.0)
