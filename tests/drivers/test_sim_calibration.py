import importlib.util
import sys
from types import ModuleType

import pytest
from sim_world import ROBOT

from tapreach.resources import resource_path


def measuring() -> ModuleType:
    path = resource_path("models") / "measure_base.py"
    spec = importlib.util.spec_from_file_location("measure_base", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["measure_base"] = module
    spec.loader.exec_module(module)
    return module


def test_robot_file_holds_what_the_measurement_gives() -> None:
    tape = measuring()
    radius = tape.measure_wheel_radius(ROBOT, duration_s=4.0)
    assert ROBOT.base.wheel_radius == pytest.approx(radius, rel=0.003)
    track = tape.measure_track(ROBOT, radius, 0.7, duration_s=5.0)
    assert ROBOT.base.track_width == pytest.approx(track, rel=0.006)


def test_what_is_random_stays_below_the_sigmas_of_the_robot_file_and_not_far_below() -> None:
    found = measuring().measure_random_errors(ROBOT, runs=8)
    base = ROBOT.base
    for said, measured in (
        (base.distance_sigma_per_sqrt_m, found.distance_per_sqrt_m),
        (base.turn_sigma_deg_per_sqrt_rad, found.turn_deg_per_sqrt_rad),
        (base.drift_sigma_deg_per_m, found.drift_deg_per_sqrt_m),
        (base.sideways_sigma_per_sqrt_m, found.sideways_per_sqrt_m),
    ):
        assert measured < said < 20.0 * measured
