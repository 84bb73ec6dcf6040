"""A drive corrected by the background of its steps: poses and mount against what they truly were."""

import math
from functools import cache

import numpy as np
import pytest
from drive import CAMERA, MOUNT, observed, poses_along
from test_rotation_from_background import room, seen

from tapreach.errors import InputError
from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.corrected_drive import SEEN_WRONG, SeenStep, corrected_drive
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise, pose_errors
from tapreach.estimation.rotation_from_background import rotation_from_background
from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import perturbed, pose_log

NOISE = OdometryNoise(turn_scale=0.03)
MOUNT_NOISE = MountNoise(0.005, math.radians(1.0))
POSES = poses_along([PlanarStep(0.2, 0.0), PlanarStep(0.0, 0.25), PlanarStep(-0.1, 0.2)])
TRIALS = 60
PLANAR_ROWS = [0, 1, 5]


def planar(step):
    return [step.x, step.y, step.heading]


def seen_steps(rng, true_poses, true_mount, points):
    """What the pictures say of every step, to a robot that believes in POSES and MOUNT."""
    steps = []
    for i in range(len(POSES) - 1):
        in_world = true_poses[i].to_rigid().apply(points)
        nominal, true = POSES[i].between(POSES[i + 1]), true_poses[i].between(true_poses[i + 1])
        pixels = seen(rng, true, true_mount, true_poses[i].to_rigid().inv().apply(in_world))
        prior = camera_step(nominal, NOISE, MOUNT, MOUNT_NOISE)
        steps.append(SeenStep(i, i + 1, rotation_from_background(*pixels, CAMERA, prior).knowledge))
    return steps


@cache
def trials():
    """Errors of the last pose and of the mount before and after, with the covariance said of them."""
    rng = np.random.default_rng(3)
    by_normal = pose_errors(POSES, NOISE)
    rows = []
    for _ in range(TRIALS):
        errors = by_normal @ rng.normal(size=by_normal.shape[2])
        true = [pose.compose(PlanarPose(*error)) for pose, error in zip(POSES, errors, strict=True)]
        off = np.repeat([MOUNT_NOISE.position_sigma, MOUNT_NOISE.angle_sigma], 3) * rng.normal(size=6)
        mount = perturbed(MOUNT, off)
        wrong = SEEN_WRONG * rng.normal(size=6)
        steps = seen_steps(rng, true, perturbed(MOUNT, off + wrong), room(rng, 900))
        drive = corrected_drive(POSES, NOISE, MOUNT, MOUNT_NOISE, steps)
        last = np.array(planar(drive.poses[-1].between(true[-1])))
        of_mount = pose_log(drive.base_from_camera.inv() * mount)
        of_base = pose_log(drive.poses[-1].to_rigid().inv() * true[-1].to_rigid())
        rows.append(
            (np.array(planar(POSES[-1].between(true[-1]))), last, off, of_mount, of_base, drive.errors)
        )
    return rows


def test_without_background_it_is_what_wheels_and_mount_say():
    drive = corrected_drive(POSES, NOISE, MOUNT, MOUNT_NOISE, [SeenStep(0, 1, NOTHING_SEEN)])
    assert list(drive.poses) == POSES
    assert np.allclose(drive.base_from_camera.as_matrix(), MOUNT.as_matrix())
    of_mount = drive.errors.by_mount
    assert np.sqrt(np.diag(of_mount @ of_mount.T)) == pytest.approx([0.005] * 3 + [math.radians(1.0)] * 3)


def test_heading_and_the_mount_turned_against_the_way_are_found():
    before, after, off, left = (np.array(column) for column in list(zip(*trials(), strict=True))[:4])
    assert np.std(after[:, 2]) < 0.4 * np.std(before[:, 2])
    pitch, yaw = 3, 4
    assert np.std(left[:, pitch]) < 0.4 * np.std(off[:, pitch])
    # A sideways slip of the wheels looks like a yaw of the mount: the rest of it stays unknown.
    assert np.std(left[:, yaw]) < 0.6 * np.std(off[:, yaw])


def test_errors_are_as_large_as_they_say():
    """In all directions in which mount and last base can err; on the floor a base has three of six."""
    squares = []
    for *_, of_mount, of_base, errors in trials():
        both = np.concatenate([errors.by_mount, errors.by_base[-1][PLANAR_ROWS]])
        sds = np.linalg.norm(both, axis=1)
        variances, directions = np.linalg.eigh((both / sds[:, None]) @ (both / sds[:, None]).T)
        found = directions.T @ (np.concatenate([of_mount, of_base[PLANAR_ROWS]]) / sds)
        squares.append((found**2 / variances)[variances > 1e-3])
    assert {len(each) for each in squares} == {9}
    assert 0.75 < np.mean(squares) < 1.3


@pytest.mark.parametrize("pair", [(0, 4), (-1, 2), (2, 1)])
def test_step_between_poses_that_are_not_there_is_refused(pair):
    with pytest.raises(InputError, match="there are 4 poses"):
        corrected_drive(POSES, NOISE, MOUNT, MOUNT_NOISE, [SeenStep(*pair, NOTHING_SEEN)])


def test_estimate_from_it_knows_the_mount_as_badly_as_with_mount_noise():
    views = observed(POSES, np.array([1.5, 0.3, 0.2]))
    drive = corrected_drive(POSES, NOISE, MOUNT, MOUNT_NOISE, [])
    found = estimate_point(views, drive.errors, with_advice=False)
    usual = estimate_point(views, NOISE, mount_noise=MOUNT_NOISE, with_advice=False)
    for name in ("point_cov_in_world", "point_cov_in_base"):
        assert getattr(found, name) == pytest.approx(getattr(usual, name), rel=0.02)
