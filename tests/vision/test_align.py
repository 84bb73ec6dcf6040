"""A patch is placed to a fraction of a pixel, and its covariance says how well."""

import math

import numpy as np
import pytest

from tapreach.vision.align import align
from tapreach.vision.patch import cut_patch
from tapreach.vision.warp import chained, inverted, scale_of, warp_at
from vision.synthetic import carried, photographed, texture, view

TAP = (330.3, 250.7)


@pytest.mark.parametrize(
    "motion",
    [
        {"shift": (3.3, -2.6)},
        {"scale": 1.08},
        {"scale": 0.93, "shift": (1.0, 1.0)},
        {"angle": 0.05, "shift": (-2.0, 0.4)},
    ],
)
def test_alignment_finds_a_known_warp(motion: dict[str, object]) -> None:
    rng = np.random.default_rng(3)
    surface = texture(3)
    first, before = view(surface)
    second, now = view(surface, **motion)
    patch = cut_patch(photographed(first, rng), *TAP)
    found = align(patch, photographed(second, rng), patch.picture_from_patch, search=4)
    assert found is not None
    assert np.linalg.norm(found.warp[:, 2] - carried(TAP, before, now)) < 0.25
    expected_scale = math.sqrt(np.linalg.det(now[:, :2]) / np.linalg.det(before[:, :2]))
    assert abs(scale_of(found.warp) - expected_scale) < 0.03
    assert found.score > 0.9


def test_brightness_does_not_shift_the_answer() -> None:
    rng = np.random.default_rng(5)
    surface = texture(5)
    first, before = view(surface)
    second, now = view(surface, shift=(1.4, 2.2))
    patch = cut_patch(photographed(first, rng), *TAP)
    darker = photographed(second, rng, gain=0.6, offset=25.0)
    found = align(patch, darker, patch.picture_from_patch, search=4)
    assert found is not None
    assert np.linalg.norm(found.warp[:, 2] - carried(TAP, before, now)) < 0.25


def test_covariance_covers_the_error() -> None:
    """Over many noisy pictures the errors are as large as the covariance says, within a factor."""
    rng = np.random.default_rng(7)
    surface = texture(7, finest=3.0, contrast=25.0)
    first, before = view(surface)
    squared = []
    for _ in range(6):
        second, now = view(surface, shift=tuple(rng.uniform(-2, 2, 2)))
        one, other = photographed(first, rng, noise=5.0), photographed(second, rng, noise=5.0)
        for tap in rng.uniform((100, 100), (540, 380), (6, 2)):
            patch = cut_patch(one, *tap)
            found = align(patch, other, patch.picture_from_patch, search=4)
            assert found is not None
            error = found.warp[:, 2] - carried(tuple(tap), before, now)
            squared.append(error @ np.linalg.solve(found.covariance, error))
    assert 0.2 < np.mean(squared) / 2.0 < 4.0


def test_worse_direction_of_an_edge_is_known_worse() -> None:
    rows, columns = np.mgrid[0:480, 0:640]
    edge = (np.where(columns > 330, 200.0, 60.0) + 6.0 * np.sin(rows / 3.0)).astype(np.float32)
    rng = np.random.default_rng(0)
    picture = photographed(edge, rng)
    patch = cut_patch(picture, 330.0, 240.0)
    found = align(patch, photographed(edge, rng), patch.picture_from_patch)
    assert found is not None
    along, across = found.covariance[1, 1], found.covariance[0, 0]
    assert along > 10.0 * across


def test_patch_off_the_picture_is_not_aligned() -> None:
    picture = photographed(view(texture(1))[0], np.random.default_rng(1))
    patch = cut_patch(picture, *TAP)
    assert align(patch, picture, warp_at(-40.0, 200.0)) is None
    assert align(patch, picture, warp_at(5000.0, 200.0), search=4) is None


def test_patch_of_one_colour_is_weak_and_does_no_harm() -> None:
    flat = np.full((480, 640), 128, np.uint8)
    patch = cut_patch(flat, *TAP)
    assert "one colour" in patch.weakness
    found = align(patch, flat, patch.picture_from_patch, search=4)
    assert found is None or found.score < 0.1


def test_warps_chain_and_invert() -> None:
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(2, 3)), rng.normal(size=(2, 3))
    point = np.array([3.0, -2.0])
    inner = b[:, :2] @ point + b[:, 2]
    np.testing.assert_allclose(chained(a, b)[:, :2] @ point + chained(a, b)[:, 2], a[:, :2] @ inner + a[:, 2])
    np.testing.assert_allclose(chained(inverted(a), a), np.eye(2, 3), atol=1e-9)
