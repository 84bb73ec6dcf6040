"""The bounds after many possible next views against the bound of each, worked out alone."""

import math
from dataclasses import replace

import numpy as np
import pytest
from drive import CENTRED_MOUNT, MOUNT, observed, poses_along

from tapreach.estimation.bound import position_bound
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.next_view import relative_sds_after
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.geometry.planar_motion import PlanarStep

TARGET = np.array([1.2, 0.05, 0.1])
STEPS = [PlanarStep(turn, advance) for turn in (0.0, -0.1, -0.3, 1.2) for advance in (0.05, 0.3)]


def bases_after(poses):
    return [poses[-1].after(step) for step in STEPS]


@pytest.mark.parametrize("motion", [None, OdometryNoise(), OdometryNoise.per_step(0.02)])
@pytest.mark.parametrize("mount_noise", [None, MountNoise(0.005, math.radians(1.0))])
def test_bounds_agree_with_those_worked_out_one_by_one(motion, mount_noise):
    poses = poses_along([PlanarStep(0.1, 0.1), PlanarStep(0.05, 0.1)])
    known, coming = observed(poses, TARGET), bases_after(poses)
    bases = np.array([pose.to_rigid().as_matrix() for pose in coming])
    found = relative_sds_after(known, motion, mount_noise, TARGET, bases)
    for pose, step, sd in zip(coming, STEPS, found, strict=True):
        if step.turn > 1.0:
            assert math.isinf(sd)  # the target has left the picture
            continue
        alone = position_bound([*known, *observed([pose], TARGET)], TARGET, motion, mount_noise)
        assert sd == pytest.approx(alone.relative_sd, rel=1e-9)


def test_next_pose_of_given_covariance_is_as_uncertain_as_the_last():
    poses = poses_along([PlanarStep(0.1, 0.1)])
    block = np.diag([1e-4, 1e-4, 1e-8, 1e-8, 1e-8, 1e-5])
    pose = poses[-1].after(PlanarStep(0.1, 0.2))
    bases = pose.to_rigid().as_matrix()[None]
    views = [*observed(poses, TARGET), *observed([pose], TARGET)]
    alone = position_bound(views, TARGET, np.stack([block] * 3))
    for given in (np.stack([block] * 2), np.kron(np.eye(2), block)):
        found = relative_sds_after(views[:2], given, None, TARGET, bases)
        assert found[0] == pytest.approx(alone.relative_sd, rel=1e-6)


def test_target_behind_a_camera_or_on_the_line_of_sight_has_no_finite_bound():
    poses = poses_along([PlanarStep(0.0, 0.1)])
    bases = poses[-1].after(PlanarStep(0.0, 0.1)).to_rigid().as_matrix()[None]
    sightings = observed(poses, np.array([1.0, 0.0, 0.15]), CENTRED_MOUNT)
    assert math.isinf(relative_sds_after(sightings, None, None, np.array([1.0, 0.0, 0.15]), bases)[0])
    ahead = observed(poses, TARGET, MOUNT)
    assert math.isinf(relative_sds_after(ahead, None, None, np.array([-1.0, 0.0, 0.1]), bases)[0])


@pytest.mark.parametrize("motion", [None, OdometryNoise(), np.stack([np.eye(6) * 1e-5] * 2)])
def test_views_along_a_way_count_together(motion):
    poses = poses_along([PlanarStep(0.1, 0.1)])
    known = observed(poses, TARGET)
    mount_noise = MountNoise(0.005, math.radians(1.0))
    ways = [
        [
            poses[-1].after(PlanarStep(turn, 0.0)),
            *(poses[-1].after(PlanarStep(turn, way)) for way in (0.1, 0.2)),
        ]
        for turn in (0.05, -0.2)
    ]
    bases = np.array([[pose.to_rigid().as_matrix() for pose in way] for way in ways])
    found = relative_sds_after(known, motion, mount_noise, TARGET, bases, (0.7, 1.5, 0.7))
    for way, sd in zip(ways, found, strict=True):
        views = [
            replace(observed([pose], TARGET)[0], pixel_sigma=sigma)
            for pose, sigma in zip(way, (0.7, 1.5, 0.7), strict=True)
        ]
        whole = np.stack([np.eye(6) * 1e-5] * 5) if isinstance(motion, np.ndarray) else motion
        alone = position_bound([*known, *views], TARGET, whole, mount_noise)
        assert sd == pytest.approx(alone.relative_sd, rel=1e-9)
