"""The turn that the background shows, against known motions of synthetic clouds of points."""

import math
from functools import cache

import numpy as np
import pytest
from drive import CAMERA, CENTRED_MOUNT, MOUNT
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.estimation.rotation_from_background import BackgroundStatus, rotation_from_background
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep

NOISE = OdometryNoise(turn_scale=0.03)
SIGMA = 0.3
TRIALS = 40
DRIVE = PlanarStep(0.2, 0.2)


def room(rng, count):
    return rng.uniform([0.6, -2.0, 0.0], [4.0, 2.0, 1.5], (count, 3))


def wall(rng, count):
    return rng.uniform([2.0, -2.0, 0.0], [2.0, 2.0, 1.5], (count, 3))


def seen(rng, true, mount, points, outliers=0.0, sigma=SIGMA, sway=0.0):
    """Pixels of what both cameras see; a share of it jumped elsewhere, the second camera swayed [rad]."""
    first = CAMERA.project(mount.inv().apply(points))
    turned = PlanarPose(heading=sway).to_rigid().rotation * mount.rotation
    swayed = RigidTransform.from_components(mount.translation, turned)
    second = CAMERA.project((true.to_rigid() * swayed).inv().apply(points))
    in_both = first.is_inside & second.is_inside
    noise = sigma * rng.normal(size=(2, int(in_both.sum()), 2))
    before, now = first.pixels[in_both] + noise[0], second.pixels[in_both] + noise[1]
    moved = int(outliers * len(now))
    now[:moved] += rng.uniform(-15.0, 15.0, (moved, 2))
    return before, now


def erring(rng, nominal):
    """How the base truly moved when the wheels say `nominal`, and the turn in excess of it."""
    errors = pose_errors([PlanarPose(), nominal], NOISE)[1]
    error = errors @ rng.normal(size=errors.shape[1])
    return nominal.compose(PlanarPose(*error)), float(error[2])


@cache
def trials(step, mount_name="ahead", surface=room, outliers=0.0):
    """(wheels' errors, turn seen minus true, its sd, NEES of the rotation, statuses) of many drives."""
    mount = MOUNT if mount_name == "ahead" else CENTRED_MOUNT
    rng = np.random.default_rng(5)
    nominal = PlanarPose().after(step)
    prior = camera_step(nominal, NOISE, mount)
    rows, statuses = [], []
    for _ in range(TRIALS):
        true, excess = erring(rng, nominal)
        found = rotation_from_background(
            *seen(rng, true, mount, surface(rng, 900), outliers), CAMERA, prior, 0.0
        )
        true_rotation = (mount.inv() * true.to_rigid() * mount).rotation
        error = (found.first_from_second.rotation.inv() * true_rotation).as_rotvec()
        nees = float(error @ np.linalg.solve(found.covariance[3:, 3:], error)) / 3.0
        rows.append((excess, found.excess_turn - excess, found.turn_sd, nees))
        statuses.append(found.status)
    return (*np.array(rows).T, statuses)


@pytest.mark.parametrize(
    ("step", "mount_name", "times_better"),
    [(DRIVE, "ahead", 15.0), (PlanarStep(0.0, 0.25), "ahead", 8.0), (PlanarStep(0.2, 0.0), "centred", 50.0)],
    ids=["turn and drive", "straight", "turn about the lens"],
)
def test_turn_is_known_far_better_than_by_the_wheels_and_honestly(step, mount_name, times_better):
    wheels, error, sd, nees, statuses = trials(step, mount_name)
    assert set(statuses) == {BackgroundStatus.CORRECTED}
    assert np.std(wheels) > times_better * np.std(error)
    assert 0.5 < np.mean((error / sd) ** 2) < 1.7
    assert 0.6 < np.mean(nees) < 1.6


def test_turning_with_a_lever_helps_a_little_and_says_so():
    wheels, error, sd, _, statuses = trials(PlanarStep(0.2, 0.0))
    assert set(statuses) == {BackgroundStatus.CORRECTED}
    assert np.std(error) < 0.6 * np.std(wheels)
    assert np.mean((error / sd) ** 2) < 1.7


def test_wall_driven_at_is_less_certain_and_says_so():
    wheels, error, sd, _, _ = trials(DRIVE, surface=wall)
    assert np.std(error) < 0.3 * np.std(wheels)
    assert np.median(sd) > 2.0 * np.median(trials(DRIVE)[2])
    assert np.median(np.abs(error / sd)) < 1.2


def test_what_all_pairs_have_wrong_in_common_is_in_the_sigma():
    rng = np.random.default_rng(8)
    nominal, squares = PlanarPose().after(DRIVE), []
    prior = camera_step(nominal, NOISE, MOUNT)
    for sway in 0.003 * rng.normal(size=TRIALS):
        true, excess = erring(rng, nominal)
        pixels = seen(rng, true, MOUNT, room(rng, 900), sway=sway)
        found = rotation_from_background(*pixels, CAMERA, prior, 0.003)
        squares.append(((found.excess_turn - excess) / found.turn_sd) ** 2)
    assert 0.6 < np.mean(squares) < 1.5


def test_third_of_pairs_that_move_on_their_own_does_little_harm():
    wheels, error, sd, _, statuses = trials(DRIVE, outliers=0.3)
    assert statuses.count(BackgroundStatus.CORRECTED) >= TRIALS - 2
    assert np.median(np.abs(error)) < 0.15 * np.median(np.abs(wheels))
    assert np.median(np.abs(error / sd)) < 1.0


def test_pairs_that_move_on_their_own_are_named():
    rng = np.random.default_rng(2)
    nominal = PlanarPose().after(DRIVE)
    before, now = seen(rng, nominal, MOUNT, room(rng, 900))
    now[:40] += [0.0, 9.0]
    found = rotation_from_background(before, now, CAMERA, camera_step(nominal, NOISE, MOUNT))
    assert found.is_used[:40].mean() < 0.2
    assert found.is_used[40:].mean() > 0.95
    assert found.noise_px == pytest.approx(SIGMA, rel=0.15)


def test_base_that_stood_still_is_seen_to():
    rng = np.random.default_rng(1)
    before, now = seen(rng, PlanarPose(), MOUNT, room(rng, 600))
    found = rotation_from_background(before, now, CAMERA, camera_step(PlanarPose(), NOISE, MOUNT))
    assert found.status is not BackgroundStatus.SLIPPED
    assert found.first_from_second.rotation.magnitude() < 1e-3


@pytest.mark.parametrize("turned", [0.12, 0.30])
def test_wheels_that_slipped_are_told(turned):
    rng = np.random.default_rng(4)
    nominal = PlanarPose().after(DRIVE)
    true = PlanarPose().after(PlanarStep(turned, 0.2))
    step = camera_step(nominal, NOISE, MOUNT)
    found = rotation_from_background(*seen(rng, true, MOUNT, room(rng, 900)), CAMERA, step)
    assert found.status is BackgroundStatus.SLIPPED
    assert "slipped" in found.reason
    assert found.excess_turn == pytest.approx(turned - DRIVE.turn, abs=5.0 * found.turn_sd)
    assert found.turn_sd < math.radians(0.2)


def scattered(rng, count):
    return rng.uniform([0.0, 0.0], [639.0, 479.0], (count, 2))


@pytest.mark.parametrize(
    ("count", "words"), [(5, "only 5 places"), (0, "only 0 places"), (120, "does not move as one")]
)
def test_no_background_is_a_result_with_the_wheels_own_word(count, words):
    rng = np.random.default_rng(0)
    step = camera_step(PlanarPose().after(DRIVE), NOISE, MOUNT)
    found = rotation_from_background(scattered(rng, count), scattered(rng, count), CAMERA, step)
    assert (found.status, found.turn_sd, found.excess_turn) == (BackgroundStatus.POOR, math.inf, 0.0)
    assert words in found.reason
    assert found.first_from_second.as_matrix() == pytest.approx(step.first_from_second.as_matrix())
    assert found.covariance == pytest.approx(step.by_normal @ step.by_normal.T)


def test_places_all_in_one_spot_do_not_show_the_turn_of_a_drive():
    rng = np.random.default_rng(0)
    nominal = PlanarPose().after(DRIVE)
    spot = np.array([1.5, 0.2, 0.2]) + rng.uniform(-0.02, 0.02, (60, 3))
    found = rotation_from_background(
        *seen(rng, nominal, MOUNT, spot), CAMERA, camera_step(nominal, NOISE, MOUNT), 0.0
    )
    assert found.turn_sd > 5.0 * np.median(trials(DRIVE)[2])


def test_arrays_that_do_not_match_are_refused():
    step = camera_step(PlanarPose().after(DRIVE), NOISE, MOUNT)
    with pytest.raises(InputError, match="both must be"):
        rotation_from_background(np.zeros((20, 2)), np.zeros((19, 2)), CAMERA, step)
