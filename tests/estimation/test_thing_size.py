"""From outlines to a size: where it stands, how it is fused, when views contradict each other."""

from dataclasses import replace

import numpy as np
import pytest

from tapreach.estimation.thing_raster import UprightRaster
from tapreach.estimation.thing_size import Silhouette, agreeing, fused, silhouette

POINT = np.array([0.5, 0.0, 0.05])
COVARIANCE = np.diag([1e-4, 1e-5, 4e-6])


def raster() -> UprightRaster:
    ahead, left = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    return UprightRaster(np.array([0.0, 0.0, 0.15]), POINT, ahead, left, 0.5, 0.002, 185, 201, 144, 100)


def of_box(across: int, above: float, bottom: float, axis: int = 100) -> Silhouette:
    made = raster()
    top, last = made.row_at(above), made.row_at(bottom)
    return silhouette(made, axis, top, np.full(last - top + 1, across // 2), 0.002)


def test_what_ends_near_the_floor_stands_on_it() -> None:
    assert of_box(30, 0.1, 0.012).foot == 0.0
    assert of_box(30, 0.2, 0.1).foot == pytest.approx(0.1, abs=0.003)


def test_rim_of_a_top_seen_from_above_is_not_its_height() -> None:
    seen = of_box(30, 0.1, 0.0)
    assert 0.09 < seen.top < 0.1 and seen.rim_sd > 0.0
    assert of_box(30, 0.2, 0.0).top == pytest.approx(0.2, abs=0.006)


def test_neck_of_a_bottle_does_not_make_it_narrow() -> None:
    made = raster()
    widths = np.concatenate([np.full(30, 5), np.full(70, 16)])
    assert silhouette(made, 100, 10, widths, 0.002).width == pytest.approx(0.064, rel=0.05)


def test_two_of_three_views_that_agree_are_taken() -> None:
    good, other, joined = of_box(32, 0.1, 0.0), of_box(34, 0.1, 0.0), of_box(80, 0.1, 0.0, axis=80)
    assert set(map(id, agreeing([good, joined, other]))) == {id(good), id(other)}
    assert agreeing([good, joined]) == () and agreeing([good]) == ()


def test_fused_middle_lies_behind_the_front_with_wider_region() -> None:
    seen = of_box(32, 0.1, 0.0, axis=95)
    size = fused([seen, replace(seen, width=seen.width + 0.004)], POINT, COVARIANCE, 0.012)
    assert size.axis_in_world[1] == pytest.approx(0.0101, abs=0.001)
    assert POINT[0] + 0.4 * size.width / 2 < size.axis_in_world[0] < POINT[0] + size.width / 2
    assert size.axis_in_world[2] == pytest.approx(size.foot + size.height / 2)
    assert np.all(np.linalg.eigvalsh(size.axis_cov_in_world - COVARIANCE) > -1e-12)
    assert size.width_sd > fused([seen, seen], POINT, COVARIANCE, 0.012).width_sd
