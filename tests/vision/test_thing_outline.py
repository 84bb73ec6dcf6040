"""The outline found by dynamic programming: shapes drawn as evidence."""

import numpy as np
import pytest

from tapreach.vision.thing_outline import Outline, best_outline

SHAPE = (90, 121)
ROWS, COLUMNS = np.indices(SHAPE)


def found(inside: np.ndarray, place: tuple[int, int], most: int = 40, noise: float = 0.0) -> Outline:
    rng = np.random.default_rng(int(inside.sum()))
    evidence = np.where(inside, 2.0, -1.5) + noise * rng.standard_normal(SHAPE)
    edges = np.abs(np.diff(inside.astype(float), axis=1, append=0.0))
    return best_outline(evidence.astype(np.float32), edges.astype(np.float32), place, most, SHAPE[0] - 1)


def box(left: int, right: int, top: int, bottom: int) -> np.ndarray:
    return np.asarray((left <= COLUMNS) & (right >= COLUMNS) & (top <= ROWS) & (bottom >= ROWS))


@pytest.mark.parametrize("place", [(30, 50), (60, 41), (78, 69)])
def test_box_is_found_from_any_place_on_it(place: tuple[int, int]) -> None:
    outline = found(box(40, 70, 20, 80), place, noise=1.0)
    assert abs(outline.axis - 55) <= 1
    assert (outline.top, outline.bottom) == (20, 80)
    assert np.median(outline.half_widths) == pytest.approx(15, abs=1)


def test_bottle_keeps_its_neck() -> None:
    bottle = box(55, 65, 10, 40) | box(45, 75, 41, 80)
    outline = found(bottle, (70, 50))
    mask = outline.mask(SHAPE)
    assert (mask & bottle).sum() / (mask | bottle).sum() > 0.93
    assert outline.half_widths[5] < 8 and outline.half_widths[-5] > 13


def test_neighbour_stays_outside_where_the_width_is_bounded() -> None:
    both = box(40, 60, 30, 80) | box(64, 100, 30, 80)
    outline = found(both, (50, 50), most=14)
    assert abs(outline.axis - 50) <= 4 and outline.half_widths.max() <= 14


def test_outline_is_cut_at_the_last_row() -> None:
    evidence = np.where(box(40, 70, 20, 89), 2.0, -1.0).astype(np.float32)
    outline = best_outline(evidence, np.zeros(SHAPE, np.float32), (50, 55), 40, 75)
    assert outline.bottom == 75


def test_place_alone_is_an_outline_where_nothing_speaks_for_a_thing() -> None:
    evidence = np.full(SHAPE, -2.0, np.float32)
    outline = best_outline(evidence, np.zeros(SHAPE, np.float32), (50, 60), 40, 80)
    assert len(outline.half_widths) == 1 and abs(outline.axis - 60) <= 1
