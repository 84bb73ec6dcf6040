"""The check whether the projection centre lies on the rotation axis."""

import math

import numpy as np
import pytest
from drive import CAMERA

from tapreach.errors import InputError
from tapreach.estimation.rotation_centre import ColumnShift, rotation_centre
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.geometry.pose import camera_mount


def shift(lever, turn, depth, side=0.0, noise=(0.0, 0.0)):
    mount = camera_mount((lever, 0.0, 0.15))
    target = np.array([lever + depth, side, 0.15])
    columns = []
    for heading in (0.0, turn):
        in_camera = (PlanarPose(heading=heading).to_rigid() * mount).inv().apply(target)
        columns.append(CAMERA.project(in_camera[None]).pixels[0, 0])
    return ColumnShift(columns[0] + noise[0], columns[1] + noise[1], depth)


@pytest.mark.parametrize("lever", [-0.05, 0.0, 0.02, 0.1, 0.25])
@pytest.mark.parametrize("turn", [math.radians(12.0), math.radians(-20.0)])
@pytest.mark.parametrize("side", [0.0, 0.08])
def test_lever_and_turn_are_recovered(lever, turn, side):
    found = rotation_centre(CAMERA, shift(lever, turn, 0.4, side), shift(lever, turn, 2.0, side))
    assert found is not None
    assert (found.lever, found.turn) == pytest.approx((lever, turn), abs=1e-8)


def test_camera_on_the_axis_keeps_near_and_far_in_one_column():
    near, far = shift(0.0, 0.2, 0.4), shift(0.0, 0.2, 2.0)
    assert near.after == pytest.approx(far.after)
    found = rotation_centre(CAMERA, near, far)
    assert found is not None and found.is_on_axis


def test_uncertainty_agrees_with_simulated_clicks():
    rng, levers, sigma = np.random.default_rng(3), [], 0.0
    for _ in range(1500):
        found = rotation_centre(
            CAMERA,
            shift(0.1, 0.25, 0.4, 0.0, rng.normal(size=2)),
            shift(0.1, 0.25, 2.0, 0.0, rng.normal(size=2)),
        )
        assert found is not None
        levers.append(found.lever)
        sigma = found.lever_sigma
    assert np.std(levers) == pytest.approx(sigma, rel=0.1)
    assert not found.is_on_axis


def test_without_a_turn_nothing_can_be_told():
    assert rotation_centre(CAMERA, shift(0.1, 0.0, 0.4), shift(0.1, 0.0, 2.0)) is None


def test_points_in_the_wrong_order_are_refused():
    with pytest.raises(InputError, match="near must be the smaller"):
        rotation_centre(CAMERA, shift(0.1, 0.2, 2.0), shift(0.1, 0.2, 0.4))
