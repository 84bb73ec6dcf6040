"""Where in a box to follow: its middle where that has texture, else the nearest place that does."""

import numpy as np

from tapreach.geometry.pixel_box import PixelBox
from tapreach.vision.extent_place import place_to_follow
from tapreach.vision.patch import cut_patch
from vision.synthetic import photographed, texture, view

BOX = PixelBox(240.0, 160.0, 400.0, 320.0)


def picture(seed: int = 3) -> np.ndarray:
    return photographed(view(texture(seed))[0], np.random.default_rng(seed))


def test_textured_middle_is_kept() -> None:
    assert place_to_follow(picture(), BOX) == BOX.middle


def test_plain_middle_gives_way_to_a_place_with_texture_inside_the_box() -> None:
    seen = picture()
    seen[200:280, 280:360] = 128
    place = place_to_follow(seen, BOX)
    assert place != BOX.middle
    assert BOX.inner(0.61).holds(place)
    assert cut_patch(seen, place.u, place.v).weakness == ""


def test_texture_behind_the_thing_does_not_draw_the_place_out_of_it() -> None:
    seen = picture()
    seen[160:321, 240:401] = 128
    seen[236:246, 336:346] = picture()[236:246, 336:346]  # a mark on a plain thing, well inside
    place = place_to_follow(seen, BOX)
    assert BOX.inner(0.61).holds(place)
    assert abs(place.u - 341.0) < 20.0
    assert abs(place.v - 241.0) < 20.0


def test_box_of_one_colour_has_its_middle_followed() -> None:
    assert place_to_follow(np.full((480, 640), 90, np.uint8), BOX) == BOX.middle


def test_place_lies_where_most_looks_like_the_thing_if_that_is_anywhere() -> None:
    own = np.zeros((480, 640), bool)
    own[:, 330:] = True
    place = place_to_follow(picture(), BOX, own)
    assert place.u > 330.0 and BOX.inner(0.61).holds(place)
    assert place_to_follow(picture(), BOX, np.zeros_like(own)) == place_to_follow(picture(), BOX)
