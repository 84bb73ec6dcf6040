"""A place without texture of its own is loose, in the direction in which it has none."""

import numpy as np

from tapreach.vision.core import looseness

SIZE = (120, 160)


def sigmas(picture: np.ndarray) -> tuple[float, float]:
    """Of the place in the middle, across and down [px]."""
    across, down = np.sqrt(np.diag(looseness(picture, 80.0, 60.0)))
    return float(across), float(down)


def test_textured_place_is_held_by_itself() -> None:
    picture = np.random.default_rng(0).integers(0, 255, SIZE).astype(np.uint8)
    assert max(sigmas(picture)) < 0.1


def test_plain_place_is_loose_however_rich_its_surroundings() -> None:
    picture = np.random.default_rng(0).integers(0, 255, SIZE).astype(np.uint8)
    picture[60 - 8 : 60 + 9, 80 - 8 : 80 + 9] = 120
    assert min(sigmas(picture)) > 1.5


def test_place_on_an_edge_is_loose_along_it_alone() -> None:
    picture = np.full(SIZE, 90, np.uint8)
    picture[:, 80:] = 170
    across, along = sigmas(picture)
    assert across < 0.2 and along > 1.5
