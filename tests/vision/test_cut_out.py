"""The parts of two pictures in which corners are followed."""

import numpy as np
import pytest

from tapreach.vision.cut_out import cut_around
from tapreach.vision.flow import FAR, NEAR, corners_near, motions_between
from vision.synthetic import photographed, texture, view

POINTS = np.array([[300.0, 200.0], [340.0, 250.0]], np.float32)
PICTURE = np.arange(480 * 640).reshape(480, 640).astype(np.uint8)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (40.4, -33.0), (330.0, 0.0), (0.0, -260.0)])
def test_parts_show_the_same_place_of_both_pictures(shift: tuple[float, float]) -> None:
    part = cut_around(PICTURE, PICTURE, POINTS, shift, 48)
    assert part is not None and part.before.shape == part.now.shape
    for piece, at in ((part.before, part.before_at), (part.now, part.now_at)):
        u, v = map(int, at)
        assert np.shares_memory(piece, PICTURE) and piece[0, 0] == PICTURE[v, u]
    np.testing.assert_array_equal(part.now_at - part.before_at, np.round(shift))


def test_nothing_is_cut_where_the_pictures_share_nothing() -> None:
    assert cut_around(PICTURE, PICTURE, POINTS, (900.0, 0.0), 48) is None
    assert motions_between(PICTURE, PICTURE, np.repeat(POINTS, 4, axis=0), (900.0, 0.0)) == ()


@pytest.mark.parametrize(("off", "room"), [(12.0, NEAR), (60.0, FAR)])
def test_motion_is_found_though_expected_elsewhere(off: float, room: int) -> None:
    rng, surface = np.random.default_rng(3), texture(3)
    pictures = [photographed(view(surface, (shift, 0.0))[0], rng) for shift in (0.0, 20.0)]
    corners = corners_near(pictures[0], 320.0, 240.0, 50.0)
    motion = motions_between(pictures[0], pictures[1], corners, (20.0 - off, 0.0), room)[0]
    moved = motion.now_from_before @ (320.0, 240.0, 1.0)
    np.testing.assert_allclose(moved, (340.0, 240.0), atol=0.2)
