"""The tracker follows what was tapped, does not drift, and says so when it cannot see it."""

from collections.abc import Iterable

import numpy as np
import pytest
from numpy.typing import NDArray

from tapreach.errors import InputError
from tapreach.vision.track import Guess, Track, TrackStatus
from tapreach.vision.tracker import PatchTracker
from vision.synthetic import carried, photographed, texture, view

TAP = (330.3, 250.7)
Flaws = dict[str, float]


def followed(
    motions: Iterable[dict[str, object]], seed: int = 0, **flaws: float
) -> tuple[list[Track], list[NDArray[np.float64]]]:
    """Tracks through a synthetic film, and the true pixels."""
    rng, surface = np.random.default_rng(seed), texture(seed)
    first, before = view(surface)
    tracker = PatchTracker(photographed(first, rng, **flaws), *TAP)
    tracks, truths = [], []
    for motion in motions:
        picture, now = view(surface, **motion)
        tracks.append(tracker.follow(photographed(picture, rng, **flaws)))
        truths.append(carried(TAP, before, now))
    return tracks, truths


def error_px(track: Track, truth: NDArray[np.float64]) -> float:
    assert track.pixel is not None, track.reason
    return float(np.linalg.norm(track.pixel.to_array() - truth))


FILMS = {
    "slow shift": [{"shift": (5.0 * i, 3.0 * i)} for i in range(1, 24)],
    "fast shift": [{"shift": (-38.0 * i, 4.0 * i)} for i in range(1, 8)],
    "coming nearer": [{"scale": 1.06**i} for i in range(1, 17)],
    "going away": [{"scale": 0.95**i} for i in range(1, 14)],
    "rolling": [{"angle": 0.02 * i} for i in range(1, 16)],
    "all at once": [{"shift": (6.0 * i, -2.0 * i), "scale": 1.03**i} for i in range(1, 20)],
}


@pytest.mark.parametrize("name", FILMS)
@pytest.mark.parametrize("seed", [0, 1])
def test_error_stays_below_half_a_pixel_times_scale(name: str, seed: int) -> None:
    tracks, truths = followed(FILMS[name], seed)
    for track, truth in zip(tracks, truths, strict=True):
        assert track.status is TrackStatus.FOLLOWED, track.reason
        assert error_px(track, truth) < 0.5 * max(1.0, track.scale)
    assert abs(track.scale - FILMS[name][-1].get("scale", 1.0)) < 0.1 * track.scale


@pytest.mark.parametrize(
    "flaws",
    [{"noise": 7.0}, {"gain": 0.7, "offset": 10.0}, {"blur": 7}],
    ids=["noise", "brightness", "motion blur"],
)
def test_camera_flaws_do_not_make_it_drift(flaws: Flaws) -> None:
    tracks, truths = followed(FILMS["all at once"], 4, **flaws)
    assert error_px(tracks[-1], truths[-1]) < 1.5
    assert error_px(tracks[-1], truths[-1]) < 3.0 * tracks[-1].sigma


def test_light_that_changes_on_the_way_is_no_loss() -> None:
    rng, surface = np.random.default_rng(2), texture(2)
    tracker = PatchTracker(photographed(view(surface)[0], rng), *TAP)
    for i in range(1, 15):
        picture, _ = view(surface, shift=(4.0 * i, 0.0))
        track = tracker.follow(photographed(picture, rng, gain=1.0 - 0.03 * i, offset=2.0 * i))
        assert track.status is TrackStatus.FOLLOWED, track.reason
    assert track.pixel is not None and abs(track.pixel.u - (TAP[0] + 56.0)) < 0.5


def test_sigma_grows_with_the_change_of_size() -> None:
    tracks, _ = followed(FILMS["coming nearer"])
    assert tracks[-1].sigma > 2.0 * tracks[0].sigma


def covered(picture: NDArray[np.float32], at: NDArray[np.float64], seed: int) -> NDArray[np.float32]:
    """The picture with a strange, well textured thing in front of the place."""
    u, v = round(float(at[0])), round(float(at[1]))
    strange = texture(100 + seed)
    picture = picture.copy()
    picture[v - 60 : v + 60, u - 60 : u + 60] = strange[300:420, 300:420]
    return picture


def test_hidden_place_is_lost_not_followed_and_found_again() -> None:
    rng, surface = np.random.default_rng(6), texture(6)
    first, before = view(surface)
    tracker = PatchTracker(photographed(first, rng), *TAP)
    statuses = []
    for i in range(1, 16):
        picture, now = view(surface, shift=(3.0 * i, 0.0))
        truth = carried(TAP, before, now)
        is_hidden = 5 <= i < 9
        track = tracker.follow(photographed(covered(picture, truth, 6) if is_hidden else picture, rng))
        statuses.append(track.status)
        assert is_hidden == (track.status is TrackStatus.LOST), f"picture {i}: {track}"
        if track.pixel is not None:
            assert error_px(track, truth) < 0.7
    assert statuses[8] is TrackStatus.UNSURE, "found again: to be confirmed first"
    assert statuses[9:] == [TrackStatus.FOLLOWED] * len(statuses[9:])


def test_hiding_thing_that_slides_in_is_not_followed() -> None:
    rng, surface = np.random.default_rng(8), texture(8)
    picture, _ = view(surface)
    tracker = PatchTracker(photographed(picture, rng), *TAP)
    for i in range(1, 20):
        front = covered(picture, np.array([TAP[0] - 120.0 + 8.0 * i, TAP[1]]), 8)
        track = tracker.follow(photographed(front, rng))
        if track.pixel is not None:
            assert abs(track.pixel.u - TAP[0]) < 2.0, "it must not go with the thing in front"
    assert track.status is TrackStatus.LOST
    assert "hidden" in track.reason


def test_guesses_lead_to_a_place_that_jumped() -> None:
    rng, surface = np.random.default_rng(9), texture(9)
    first, before = view(surface)
    second, now = view(surface, shift=(170.0, -40.0), scale=1.2)
    truth = carried(TAP, before, now)
    along_a_line = [Guess(truth[0] + 5 + 20 * k, truth[1] - 4 + 3 * k, 1.2) for k in range(-6, 7)]
    tracker = PatchTracker(photographed(first, rng), *TAP)
    track = tracker.follow(photographed(second, rng), along_a_line)
    assert error_px(track, truth) < 1.0


def test_two_places_alike_are_no_answer_once_lost() -> None:
    rng = np.random.default_rng(10)
    tile = texture(10)[400:464, 400:464]
    wall = np.tile(tile, (8, 10))[:480, :640]
    tracker = PatchTracker(photographed(wall, rng), *TAP)
    assert tracker.follow(photographed(np.full_like(wall, 90.0), rng)).status is TrackStatus.LOST
    for _ in range(12):
        track = tracker.follow(photographed(np.roll(wall, 32, axis=1), rng))
        assert track.status is not TrackStatus.FOLLOWED


def test_leaving_the_picture_is_said() -> None:
    tracks, _ = followed([{"shift": (30.0 * i, 0.0)} for i in range(1, 14)])
    assert tracks[5].status is TrackStatus.FOLLOWED
    assert tracks[-1].status is TrackStatus.LOST


def test_one_colour_is_never_called_followed() -> None:
    rng = np.random.default_rng(0)
    flat = np.full((480, 640), 128.0, np.float32)
    tracker = PatchTracker(photographed(flat, rng), *TAP)
    assert "one colour" in tracker.weakness
    for _ in range(4):
        assert tracker.follow(photographed(flat, rng)).status is not TrackStatus.FOLLOWED


@pytest.mark.parametrize("pixel", [(-1.0, 10.0), (640.0, 10.0), (10.0, 480.0), (float("nan"), 10.0)])
def test_tap_outside_the_picture_is_refused(pixel: tuple[float, float]) -> None:
    with pytest.raises(InputError, match="pixel"):
        PatchTracker(np.zeros((480, 640), np.uint8), *pixel)


@pytest.mark.parametrize("pixel", [(0.0, 0.0), (639.0, 479.0), (0.0, 240.0)])
def test_tap_at_the_very_edge_does_no_harm(pixel: tuple[float, float]) -> None:
    rng, surface = np.random.default_rng(3), texture(3)
    tracker = PatchTracker(photographed(view(surface)[0], rng), *pixel)
    for i in range(3):
        assert tracker.follow(photographed(view(surface, shift=(i, i))[0], rng)).status in TrackStatus


def test_picture_of_another_size_is_refused() -> None:
    tracker = PatchTracker(np.zeros((480, 640), np.uint8), *TAP)
    with pytest.raises(InputError, match="320 by 240"):
        tracker.follow(np.zeros((240, 320), np.uint8))
