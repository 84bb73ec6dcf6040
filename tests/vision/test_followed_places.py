"""The same places in all pictures of a turn: where they lie, and which are left out."""

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.vision.followed_places import followed_places
from tapreach.vision.image_io import Gray
from vision.synthetic import photographed, texture, view

TO_AND_FRO = [0.0, 14.0, 31.0, 52.0, 40.0, 15.0, -12.0, -38.0, -55.0, -30.0, -2.0]


def film(shifts: list[float], blur: int = 0) -> list[Gray]:
    rng = np.random.default_rng()
    surface = texture(int(rng.integers(6)))
    return [photographed(view(surface, (shift, 0.3 * shift))[0], rng, blur=blur) for shift in shifts]


@pytest.mark.parametrize("blur", [0, 6])
def test_places_move_as_the_picture_does(blur: int) -> None:
    followed = followed_places(film(TO_AND_FRO, blur))
    pictures, places, _ = followed.pixels.shape
    assert pictures == len(TO_AND_FRO)
    assert 60 < places <= followed.begun_with
    moved = followed.pixels - followed.pixels[0]
    expected = np.array([(shift, 0.3 * shift) for shift in TO_AND_FRO])[:, None]
    apart = np.linalg.norm(moved - expected, axis=2)
    assert np.median(apart) < 0.25
    assert np.percentile(apart, 95) < 1.0


def test_place_that_leaves_the_picture_once_is_left_out_of_all() -> None:
    followed = followed_places(film([0.0, 25.0, 50.0, 75.0, 50.0, 25.0, 0.0]))
    assert len(followed.pixels[0]) > 60
    assert followed.pixels[0][:, 0].max() < 640 - 75


def test_nothing_is_followed_over_pictures_of_one_colour() -> None:
    grey = np.full((480, 640), 90, np.uint8)
    followed = followed_places([grey, grey, grey])
    assert followed.pixels.shape == (3, 0, 2) and followed.begun_with == 0


def test_picture_that_shows_something_else_ends_all() -> None:
    rng = np.random.default_rng()
    pictures = film([0.0, 10.0, 20.0])
    pictures[1] = photographed(view(texture(7))[0], rng)
    assert followed_places(pictures).pixels.shape[1] < 8


def test_pictures_of_different_sizes_are_refused() -> None:
    with pytest.raises(InputError, match="shapes"):
        followed_places([np.zeros((480, 640), np.uint8), np.zeros((240, 320), np.uint8)])
    with pytest.raises(InputError, match="a picture at least"):
        followed_places([])
