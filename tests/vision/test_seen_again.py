"""A thing is found again by how it looked: pushed, nearer or farther; and what is not there is not found."""

import cv2
import numpy as np
import pytest

from tapreach.vision.seen_again import Expected, seen_again

SIZE = (360, 480)


def textured(rng: np.random.Generator, shape: tuple[int, int], grain: float) -> np.ndarray:
    noise = cv2.GaussianBlur(rng.normal(size=shape).astype(np.float32), (0, 0), grain)
    return np.clip(128.0 + 45.0 * noise / noise.std(), 0, 255)


def scene(background: np.ndarray, thing: np.ndarray, u: float, v: float, scale: float = 1.0) -> np.ndarray:
    """A picture with the thing's middle at (u, v), `scale` times as large as it is."""
    half = (thing.shape[0] - 1) / 2.0
    warp = np.array([[scale, 0.0, u - scale * half], [0.0, scale, v - scale * half]])
    mask = cv2.warpAffine(np.ones_like(thing), warp, SIZE[::-1])
    shown = cv2.warpAffine(thing, warp, SIZE[::-1], flags=cv2.INTER_LINEAR)
    return np.asarray(mask * shown + (1.0 - mask) * background).astype(np.uint8)


def around(u: float, v: float, sd: float, *scales: float) -> Expected:
    return Expected(np.array([u, v]), sd**2 * np.eye(2), scales or (1.0,))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("moved", "scale"), [((0.0, 0.0), 1.0), ((38.0, -20.0), 0.85), ((-30.0, 25.0), 1.15)]
)
def test_thing_is_found_where_it_was_pushed_to(seed: int, moved: tuple[float, float], scale: float) -> None:
    rng = np.random.default_rng(seed)
    floor, thing = textured(rng, SIZE, 6.0), textured(rng, (61, 61), 2.5)
    earlier = scene(floor, thing, 240.0, 180.0)
    place = 240.0 + moved[0], 180.0 + moved[1]
    there = around(240.0, 180.0, 22.0, 1.0, 0.87, 1.15)
    found = seen_again(earlier, (240.0, 180.0), 30.0, scene(floor, thing, *place, scale), there)
    assert found is not None
    np.testing.assert_allclose(found.pixel, place, atol=2.0)
    assert found.scale == pytest.approx(scale, rel=0.08)


@pytest.mark.parametrize("seed", range(4))
def test_thing_that_is_gone_is_not_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    floor, thing = textured(rng, SIZE, 6.0), textured(rng, (61, 61), 2.5)
    earlier = scene(floor, thing, 240.0, 180.0)
    there = around(240.0, 180.0, 20.0)
    assert seen_again(earlier, (240.0, 180.0), 30.0, floor.astype(np.uint8), there) is None


def test_of_two_alike_that_could_both_be_it_neither_is_taken_and_a_far_one_does_not_count() -> None:
    rng = np.random.default_rng(3)
    floor, thing = textured(rng, SIZE, 6.0), textured(rng, (41, 41), 2.5)
    earlier = scene(floor, thing, 240.0, 180.0)
    picture = scene(scene(floor, thing, 200.0, 180.0), thing, 280.0, 180.0)
    assert seen_again(earlier, (240.0, 180.0), 20.0, picture, around(240.0, 180.0, 25.0)) is None
    nearer = seen_again(earlier, (240.0, 180.0), 20.0, picture, around(270.0, 180.0, 8.0))
    assert nearer is not None and nearer.pixel[0] == pytest.approx(280.0, abs=1.0)


def test_place_at_the_edge_of_the_picture_does_no_harm() -> None:
    rng = np.random.default_rng(5)
    floor, thing = textured(rng, SIZE, 6.0), textured(rng, (61, 61), 2.5)
    earlier, picture = scene(floor, thing, 240.0, 180.0), scene(floor, thing, 470.0, 350.0)
    found = seen_again(earlier, (240.0, 180.0), 30.0, picture, around(476.0, 356.0, 15.0))
    assert found is None or np.hypot(*(found.pixel - (470.0, 350.0))) < 3.0
