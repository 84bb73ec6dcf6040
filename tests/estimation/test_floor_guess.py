"""The position on the floor from one view."""

import math

import numpy as np
import pytest
from drive import CAMERA, MOUNT
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.floor_guess import FloorStatus, floor_guess
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pose import camera_mount, perturbed


def pixel_of(point, mount=MOUNT):
    u, v = CAMERA.project(mount.inv().apply(np.array(point))[None]).pixels[0]
    return Pixel(float(u), float(v))


@pytest.mark.parametrize("place", [(0.8, 0.1, 0.0), (0.5, -0.1, 0.0), (1.2, 0.3, 0.0)])
def test_place_on_the_floor_is_found(place):
    guess = floor_guess(pixel_of(place), CAMERA, MOUNT)
    assert guess.status is FloorStatus.ON_FLOOR
    np.testing.assert_allclose(guess.point_in_base, place, atol=1e-9)


def test_covariance_agrees_with_simulated_errors():
    rng, place = np.random.default_rng(6), (0.7, 0.1, 0.0)
    sigmas = {"pixel_sigma": 2.0, "angle_sigma": 0.005, "height_sigma": 0.003}
    found = []
    for _ in range(2000):
        pixel = pixel_of(place)
        tapped = Pixel(pixel.u + 2.0 * rng.normal(), pixel.v + 2.0 * rng.normal())
        turned = perturbed(MOUNT, [0, 0, 0, *(0.005 * rng.normal(size=3))])
        raised = RigidTransform.from_translation([0.0, 0.0, 0.003 * rng.normal()]) * turned
        found.append(floor_guess(tapped, CAMERA, raised, **sigmas).point_in_base[:2])
    guess = floor_guess(pixel_of(place), CAMERA, MOUNT, **sigmas)
    simulated = np.cov(np.array(found).T)
    expected = guess.point_cov_in_base[:2, :2]
    scale = np.outer(*[np.sqrt(np.diag(expected))] * 2)
    np.testing.assert_allclose(simulated / scale, expected / scale, atol=0.15)
    np.testing.assert_allclose(guess.point_cov_in_base[2], 0.0, atol=1e-12)


def test_tap_above_the_horizon_has_no_floor():
    level = camera_mount((0.1, 0.0, 0.15))
    guess = floor_guess(Pixel(320.0, 100.0), CAMERA, level)
    assert (guess.status, guess.point_in_base) == (FloorStatus.ABOVE_HORIZON, None)


def test_tap_just_below_the_horizon_has_no_honest_range():
    level = camera_mount((0.1, 0.0, 0.15))
    guess = floor_guess(Pixel(320.0, 245.0), CAMERA, level)
    assert (guess.status, guess.point_in_base) == (FloorStatus.NEAR_HORIZON, None)


def test_tap_outside_the_picture_is_refused():
    with pytest.raises(InputError, match="outside the picture"):
        floor_guess(Pixel(700.0, 10.0), CAMERA, MOUNT)


def test_uncertain_pitch_matters_more_the_farther_it_is():
    sds = []
    for x in (0.5, 1.5):
        guess = floor_guess(pixel_of((x, 0.0, 0.0)), CAMERA, MOUNT, angle_sigma=math.radians(0.5))
        sds.append(math.sqrt(guess.point_cov_in_base[0, 0]))
    assert sds[1] > 5.0 * sds[0]
