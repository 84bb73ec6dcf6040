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
