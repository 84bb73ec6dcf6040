"""A patch agrees with other pictures where it lies, whatever part of it shows something else."""

import numpy as np
import pytest

from tapreach.vision.depth_curve import DepthCurve
from tapreach.vision.depth_sweep import DepthSweep, pyramid_of
from tapreach.vision.patch import patch_of_half
from tapreach.vision.warp import warp_at
from vision.synthetic import photographed, texture, view

PLACE = (330.0, 250.0)
DISPARITIES = np.arange(-30.0, 30.5, 1.0)
EXACT = 0.01 * np.eye(2)


def at(disparities, scale=1.0):
    """Warps (m, 2, 3): the place moved sideways, seen at `scale`."""
    return np.stack([warp_at(PLACE[0] + d, PLACE[1], scale) for d in disparities])


def plain(value=120.0):
    return np.full((480, 640), value, dtype=np.float32)


def swept(first, others, covariance=EXACT, reach=0):
    rng = np.random.default_rng(4)
    sweep = DepthSweep(patch_of_half(photographed(first, rng), warp_at(*PLACE), 8))
    pyramids = [pyramid_of(photographed(other, rng)) for other in others]
    return sweep, [sweep.compare(pyramid, at(DISPARITIES), covariance, reach) for pyramid in pyramids]


def curve_of(first, others):
    sweep, compared = swept(first, others)
    return DepthCurve.of(DISPARITIES, [each.cost for each in compared], sweep.most_cost)


def test_textured_place_has_one_clear_valley_where_it_is():
    surface = texture(3)
    first, _ = view(surface)
    curve = curve_of(first, [view(surface, (7.4, 0.0))[0]] * 3)
    assert curve.is_clear
    assert curve.inverse_depth == pytest.approx(7.4, abs=0.3)
    assert curve.sigma <= 1.0


def test_plain_place_has_no_clear_valley():
    assert not curve_of(plain(), [plain()] * 3).is_clear


def test_stripes_have_a_valley_for_every_stripe():
    stripes = plain() + 50.0 * np.sin(2.0 * np.pi * np.arange(640) / 12.0, dtype=np.float32)
    curve = curve_of(stripes, [np.roll(stripes, 6, axis=1)] * 3)
    assert not curve.is_clear
    assert curve.margin < 12.0


def test_patch_half_of_which_shows_what_is_behind_is_found_by_its_own_half():
    rng = np.random.default_rng(9)
    behind, front = texture(5), texture(6)

    def seen(disparity):
        picture, _ = view(behind, (-12.0 * disparity / 9.0, 0.0))
        thing, _ = view(front, (disparity, 0.0))
        edge = round(PLACE[0] + 3 + disparity)
        picture = picture.copy()
        picture[:, edge - 60 : edge] = thing[:, edge - 60 : edge]
        return picture

    sweep, compared = swept(seen(0.0), [seen(9.0)] * 3)
    curve = DepthCurve.of(DISPARITIES, [each.cost for each in compared], sweep.most_cost)
    assert curve.inverse_depth == pytest.approx(9.0, abs=0.5)
    layer = compared[0].agreement[curve.best].reshape(17, 17)
    assert layer[:, :9].mean() > layer[:, 13:].mean() + 0.25
    warp = at([9.0])[0]
    own = sweep.agreement(pyramid_of(photographed(seen(9.0), rng)), warp, layer.ravel())
    elsewhere = sweep.agreement(pyramid_of(photographed(seen(9.0), rng)), at([16.0])[0], layer.ravel())
    assert own > 0.7 > elsewhere


def test_brighter_picture_agrees_as_well():
    surface = texture(8)
    rng = np.random.default_rng(1)
    first, _ = view(surface)
    sweep = DepthSweep(patch_of_half(photographed(first, rng), warp_at(*PLACE), 8))
    picture = photographed(view(surface, (4.0, 0.0))[0], rng, gain=1.15, offset=-12.0)
    found = sweep.compare(pyramid_of(picture), at(DISPARITIES), EXACT, 0)
    assert DISPARITIES[int(np.nanargmin(found.cost))] == 4.0


def test_place_beside_the_line_is_found_as_far_as_the_poses_are_not_known():
    surface = texture(3)
    first, _ = view(surface)
    off_by_two = view(surface, (5.0, 2.0))[0]
    sweep, (exact,) = swept(first, [off_by_two])
    _, (unsure,) = swept(first, [off_by_two], covariance=1.5**2 * np.eye(2), reach=3)
    best = int(np.nanargmin(unsure.cost))
    assert DISPARITIES[best] + unsure.shifts[best, 0] == 5.0
    assert unsure.shifts[best, 1] == 2.0
    assert unsure.cost[best] < 0.5 * np.nanmin(exact.cost) < sweep.most_cost


def test_place_seen_twice_as_large_is_compared_with_a_smaller_picture():
    surface = texture(7)
    rng = np.random.default_rng(2)
    first, _ = view(surface)
    larger, _ = view(surface, scale=2.0)
    sweep = DepthSweep(patch_of_half(photographed(first, rng), warp_at(*PLACE), 8))
    middle = np.array([319.5, 239.5])
    u, v = middle + 2.0 * (PLACE - middle)
    right = np.stack([warp_at(u + shift, v, 2.0) for shift in (-24.0, 0.0, 24.0)])
    found = sweep.compare(pyramid_of(photographed(larger, rng)), right, EXACT, 0)
    assert int(np.nanargmin(found.cost)) == 1


def test_place_beyond_the_picture_costs_what_chance_would():
    surface = texture(3)
    first, _ = view(surface)
    sweep, _ = swept(first, [])
    pyramid = pyramid_of(photographed(first, np.random.default_rng(0)))
    found = sweep.compare(pyramid, at([0.0, 900.0]), EXACT, 0)
    assert np.isnan(found.cost[1])
    filled = DepthCurve.of(np.array([0.0, 1.0]), [np.array([np.nan, np.nan])], 7.0)
    assert list(filled.costs) == [7.0, 7.0]


def test_curve_whose_valley_is_at_an_end_is_not_clear():
    depths = np.arange(10.0)
    assert not DepthCurve(depths, 30.0 * depths).is_clear
    assert DepthCurve(depths, 30.0 * (depths - 4.2) ** 2).is_clear
    assert DepthCurve(depths, 30.0 * (depths - 4.2) ** 2).inverse_depth == pytest.approx(4.2)
