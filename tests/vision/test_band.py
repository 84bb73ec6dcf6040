"""Look-alikes beside the guesses are refused; what lies along them is not."""

import math

import numpy as np
import pytest

from tapreach.geometry.pixel import ImageSize
from tapreach.vision.band import Band
from tapreach.vision.track import Guess, TrackStatus
from tapreach.vision.tracker import PatchTracker
from vision.synthetic import photographed, texture, view

LINE = [Guess(300.0 + 10.0 * k, 200.0 + 5.0 * k, 1.0 + 0.05 * k, 2.0) for k in (3, 0, 1, 2, 4, 5)]


def test_place_between_two_guesses_is_held() -> None:
    assert Band.around(LINE).holds(315.0, 207.5)


@pytest.mark.parametrize("across, is_held", [(5.0, True), (-5.0, True), (7.0, False), (-7.0, False)])
def test_gate_is_three_sigma_across_the_line(across: float, is_held: bool) -> None:
    normal = np.array([-1.0, 2.0]) / math.sqrt(5.0)
    u, v = np.array([315.0, 207.5]) + across * normal
    assert Band.around(LINE).holds(u, v) == is_held


def test_place_beyond_the_ends_is_refused() -> None:
    assert not Band.around(LINE).holds(290.0, 195.0)
    assert not Band.around(LINE).holds(362.0, 231.0)


def test_wrong_size_is_refused() -> None:
    band = Band.around(LINE)
    assert band.holds(315.0, 207.5, 1.1)
    assert not band.holds(315.0, 207.5, 2.0)
    assert not band.holds(315.0, 207.5, 0.5)


def test_band_grows_while_the_place_is_lost() -> None:
    assert not Band.around(LINE).holds(311.0, 215.0)
    assert Band.around(LINE, lost_for=20).holds(311.0, 215.0)


def test_guess_without_a_sigma_refuses_nothing() -> None:
    band = Band.around([Guess(10.0, 10.0)])
    assert band.holds(600.0, 400.0, 9.0)
    assert band.expected() is None


def test_single_guess_is_a_circle() -> None:
    band = Band.around([Guess(100.0, 100.0, 1.0, 2.0)])
    assert band.holds(104.0, 104.0)
    assert not band.holds(105.0, 105.0)
    assert band.length == pytest.approx(12.0)


def test_expectation_is_the_first_guess_and_long_along_the_line() -> None:
    expected = Band.around(LINE).expected()
    assert expected is not None
    place, covariance = expected
    np.testing.assert_allclose(place, (330.0, 215.0))
    values, axes = np.linalg.eigh(covariance)
    assert values[0] == pytest.approx(4.0)
    assert abs(axes[:, 1] @ np.array([2.0, 1.0])) == pytest.approx(math.sqrt(5.0))


def test_guesses_beyond_the_edge_are_not_inside() -> None:
    assert Band.around(LINE).is_inside(ImageSize(640, 480))
    assert not Band.around(LINE).is_inside(ImageSize(340, 480))


def test_look_alike_beside_the_line_is_not_followed() -> None:
    """Two equal things; the tapped one is covered, the other stands beside where it can be."""
    rng, surface = np.random.default_rng(3), texture(3)
    picture, _ = view(surface)
    twin = picture.copy()
    twin[220:281, 400:461] = picture[220:281, 300:361]
    tracker = PatchTracker(photographed(twin, rng), 330.0, 250.0)
    covered = twin.copy()
    covered[190:311, 270:391] = texture(77)[300:421, 300:421]
    for _ in range(6):
        track = tracker.follow(photographed(covered, rng), [Guess(331.0, 250.0, 1.0, 3.0)])
        assert track.status is TrackStatus.LOST


def test_place_that_cannot_be_in_the_picture_is_lost_at_once() -> None:
    rng, surface = np.random.default_rng(5), texture(5)
    picture = photographed(view(surface)[0], rng)
    tracker = PatchTracker(picture, 330.0, 250.0)
    track = tracker.follow(picture, [])
    assert track.status is TrackStatus.LOST
    assert "left the picture" in track.reason
    assert tracker.follow(picture, [Guess(330.0, 250.0, 1.0, 3.0)]).is_seen
