"""Places of the whole picture in two frames, against pictures whose motion is known exactly."""

import cv2
import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.vision.background_corners import Box
from tapreach.vision.background_motion import BackgroundQuality, BackgroundTracker
from vision.synthetic import SIZE, photographed, texture, view


def followed(steps, masked=(), change=lambda picture: picture):
    """A tracker fed with a surface that moves, and where each of its pairs should have ended."""
    rng = np.random.default_rng(0)
    first, first_warp = view(texture(3))
    tracker = BackgroundTracker(photographed(first, rng), masked)
    warp = first_warp
    for shift, scale, angle in steps:
        picture, warp = view(texture(3), shift, scale, angle)
        tracker.follow(photographed(change(picture), rng))
    return tracker.pairs(), first_warp, warp


def errors_of(pairs, first_warp, warp):
    """How far the pairs (n,) are from where they should be [px]."""
    on_surface = np.linalg.solve(first_warp[:, :2], (pairs.first - first_warp[:, 2]).T)
    expected = (warp[:, :2] @ on_surface).T + warp[:, 2]
    return np.linalg.norm(pairs.now - expected, axis=1)


DRIVE = [((9.0 * i, 2.0 * i), 1.0 + 0.015 * i, 0.004 * i) for i in range(1, 11)]


def test_pairs_are_right_to_a_fraction_of_a_pixel():
    pairs, first_warp, warp = followed(DRIVE)
    errors = errors_of(pairs, first_warp, warp)
    assert pairs.quality is BackgroundQuality.GOOD and len(errors) > 60
    assert np.median(errors) < 0.35
    assert np.quantile(errors, 0.95) < 1.0


def test_long_way_adds_no_drift():
    there_and_back = [((8.0 * (20 - abs(20 - i)), 0.0), 1.0, 0.0) for i in range(1, 41)]
    pairs, first_warp, warp = followed(there_and_back)
    assert np.median(errors_of(pairs, first_warp, warp)) < 0.15


def test_picture_that_stands_still_gives_the_same_places():
    pairs, first_warp, warp = followed([((0.0, 0.0), 1.0, 0.0)] * 3)
    assert len(pairs.first) > 150
    assert np.median(errors_of(pairs, first_warp, warp)) < 0.1


def test_failure_within_opencv_costs_no_pairs(monkeypatch):
    find = cv2.findFundamentalMat

    def failing(first, now, method, *others):
        if method >= cv2.USAC_DEFAULT:
            raise cv2.error("!model.empty()")
        return find(first, now, method, *others)

    usual, *_ = followed(DRIVE)
    monkeypatch.setattr(cv2, "findFundamentalMat", failing)
    pairs, first_warp, warp = followed(DRIVE)
    assert len(pairs.now) > 0.9 * len(usual.now)
    assert np.quantile(errors_of(pairs, first_warp, warp), 0.95) < 1.0


def test_places_cover_the_whole_picture():
    pairs, _, _ = followed([((0.0, 0.0), 1.0, 0.0)])
    quarters = {(u > 320.0, v > 240.0) for u, v in pairs.first}
    assert len(quarters) == 4


def test_masked_part_is_left_alone():
    pairs, _, _ = followed([((3.0, 0.0), 1.0, 0.0)], [Box(200.0, 100.0, 639.0, 300.0)])
    u, v = pairs.first.T
    assert not np.any((u >= 200.0) & (v >= 100.0) & (v <= 300.0))
    assert len(u) > 40


def test_part_that_gets_covered_is_left_out():
    def covered(picture):
        changed = picture.copy()
        changed[100:380, 200:440] = texture(9)[100:380, 200:440]
        return changed

    pairs, first_warp, warp = followed(DRIVE[:4], change=covered)
    errors = errors_of(pairs, first_warp, warp)
    assert len(errors) > 40
    assert np.mean(errors > 2.0) < 0.03


@pytest.mark.parametrize("value", [0, 90, 255])
def test_picture_of_one_colour_is_poor(value):
    rng = np.random.default_rng(0)
    plain = np.full(SIZE, float(value), np.float32)
    tracker = BackgroundTracker(photographed(plain, rng))
    tracker.follow(photographed(plain, rng))
    pairs = tracker.pairs()
    assert pairs.quality is BackgroundQuality.POOR
    assert "little texture" in pairs.reason
    assert pairs.first.shape == pairs.now.shape == (0, 2)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda picture: np.random.default_rng(1).uniform(0.0, 255.0, picture.shape).astype(np.float32),
        lambda picture: np.full_like(picture, 128.0),
        lambda picture: cv2.blur(picture, (61, 61)),
    ],
    ids=["noise", "nothing", "blur"],
)
def test_picture_that_shows_nothing_of_it_is_poor_with_a_reason(spoil):
    pairs, _, _ = followed(DRIVE[:2], change=spoil)
    assert pairs.quality is BackgroundQuality.POOR
    assert "corners" in pairs.reason


def test_lost_for_good_stays_poor_when_the_picture_returns():
    rng = np.random.default_rng(0)
    shown = photographed(view(texture(3))[0], rng)
    tracker = BackgroundTracker(shown)
    tracker.follow(np.zeros(SIZE, np.uint8))
    assert len(tracker) < 15
    tracker.follow(shown)
    assert tracker.pairs().quality is BackgroundQuality.POOR


def test_picture_of_another_size_is_refused():
    tracker = BackgroundTracker(np.zeros(SIZE, np.uint8))
    with pytest.raises(InputError, match="shape"):
        tracker.follow(np.zeros((240, 320), np.uint8))
