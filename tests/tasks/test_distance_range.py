"""Sightings narrow the distances that are left, and the guesses made from them hold the place."""

from dataclasses import replace

import numpy as np
import pytest

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.tasks.distance_range import DistanceRange
from tapreach.tasks.sighting import Sighting
from tapreach.vision.band import Band
from tasks.rig import sim_description

ROBOT = sim_description()
START = PlanarPose()
WAY = [START.after(PlanarStep(0.02 * k, 0.03 * k)) for k in range(8)]


def seen(point, pose: PlanarPose) -> Sighting:
    camera_from_world = (pose.to_rigid() * ROBOT.camera.mount.base_from_camera()).inv()
    in_camera = camera_from_world.apply(point)
    (pixel,) = ROBOT.camera.model().project([in_camera]).pixels
    first = (START.to_rigid() * ROBOT.camera.mount.base_from_camera()).inv().apply(point)[2]
    return Sighting(1, 1, Pixel(*map(float, pixel)), 0.3, float(first / in_camera[2]), pose)


def spread_of(guesses) -> float:
    places = np.array([(guess.u, guess.v) for guess in guesses])
    return float(np.linalg.norm(np.ptp(places, axis=0)))


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.5])
def test_guesses_hold_the_place_all_the_way(distance: float) -> None:
    point = np.array([distance + 0.1, 0.06, 0.05])
    first = last = seen(point, START)
    reach = DistanceRange(first, ROBOT)
    for pose in WAY[1:]:
        truth = seen(point, pose)
        band = Band.around(reach.guesses(last, pose))
        assert band.holds(truth.pixel.u, truth.pixel.v, truth.scale)
        reach.note(truth)
        last = truth


def test_motion_narrows_what_is_left() -> None:
    point = np.array([0.6, 0.08, 0.05])
    reach = DistanceRange(seen(point, START), ROBOT)
    before = spread_of(reach.guesses(seen(point, START), WAY[-1]))
    for pose in WAY[1:-1]:
        reach.note(seen(point, pose))
    after = spread_of(reach.guesses(seen(point, WAY[-2]), WAY[-1]))
    assert after < 0.3 * before


def test_likeliest_guess_comes_first() -> None:
    point = np.array([0.6, 0.08, 0.05])
    reach = DistanceRange(seen(point, START), ROBOT)
    for pose in WAY[1:-1]:
        reach.note(seen(point, pose))
    truth, guess = seen(point, WAY[-1]), reach.guesses(seen(point, WAY[-2]), WAY[-1])[0]
    assert np.hypot(guess.u - truth.pixel.u, guess.v - truth.pixel.v) < 3.0
    assert guess.scale == pytest.approx(truth.scale, rel=0.05)


def test_wrong_last_sighting_is_not_believed_for_ever() -> None:
    """What was followed wrong, and says that it is unsure, leads back towards what the tap leads to."""
    point = np.array([1.2, 0.08, 0.05])
    reach = DistanceRange(seen(point, START), ROBOT)
    for pose in WAY[1:-1]:
        reach.note(seen(point, pose))
    right = seen(point, WAY[-2])
    wrong = replace(right, pixel=Pixel(right.pixel.u + 30.0, right.pixel.v), sigma=20.0)
    truth, guess = seen(point, WAY[-1]), reach.guesses(wrong, WAY[-1])[0]
    assert abs(guess.u - truth.pixel.u) < 15.0


def test_place_behind_the_robot_gets_no_guess() -> None:
    first = seen(np.array([1.0, 0.0, 0.1]), START)
    reach = DistanceRange(first, ROBOT)
    assert reach.guesses(first, START.after(PlanarStep(1.5, 0.0))) == ()
