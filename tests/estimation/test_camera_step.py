"""What the wheels say of the camera's motion: its linear errors against errors really made."""

import math

import numpy as np
import pytest
from drive import MOUNT

from tapreach.estimation.camera_step import camera_step, inverse_adjoint
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import perturbed, pose_log

STEP = PlanarPose(0.22, 0.05, 0.2)


def test_second_camera_is_seen_from_the_first():
    step = camera_step(STEP, OdometryNoise(), MOUNT)
    in_second = np.array([0.1, 0.2, 1.5])
    in_world = (STEP.to_rigid() * MOUNT).apply(in_second)
    assert step.first_from_second.apply(in_second) == pytest.approx(MOUNT.inv().apply(in_world))


def test_turn_axis_is_up():
    step = camera_step(STEP, OdometryNoise(), MOUNT)
    assert MOUNT.rotation.apply(step.turn_axis) == pytest.approx([0.0, 0.0, 1.0])


def test_turn_sd_is_that_of_the_odometry():
    noise = OdometryNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.03, 0.0, 0.0)
    step = camera_step(PlanarPose(heading=0.4), noise, MOUNT)
    assert step.turn_sd == pytest.approx(0.012, rel=1e-6)


@pytest.mark.parametrize("axis", range(6))
def test_base_that_is_off_displaces_the_camera_as_its_adjoint_says(axis):
    error = 1e-6 * np.eye(6)[axis]
    true = perturbed(STEP.to_rigid(), error) * MOUNT
    assert pose_log((STEP.to_rigid() * MOUNT).inv() * true) == pytest.approx(
        inverse_adjoint(MOUNT) @ error, abs=1e-11
    )


@pytest.mark.parametrize("axis", range(6))
def test_mount_that_is_off_displaces_both_cameras(axis):
    off = perturbed(MOUNT, 1e-6 * np.eye(6)[axis])
    step = camera_step(STEP, OdometryNoise(), MOUNT, MountNoise(1.0, 1.0))
    true = off.inv() * STEP.to_rigid() * off
    assert pose_log(step.first_from_second.inv() * true) == pytest.approx(
        1e-6 * step.by_mount[:, axis], abs=1e-11
    )


def test_slip_leaves_nothing_but_the_mount_known():
    step = camera_step(STEP, OdometryNoise(), MOUNT, MountNoise(0.003, math.radians(0.5))).with_slip()
    assert step.turn_sd > math.radians(10.0)
    assert np.linalg.norm(step.by_wheels[:3]) > 0.1
