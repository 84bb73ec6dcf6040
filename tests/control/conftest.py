from pathlib import Path

import pytest

from tapreach.robot.clock import ManualClock
from tapreach.robot.config import RobotDescription, load_robot

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


@pytest.fixture(scope="session")
def description() -> RobotDescription:
    return load_robot(ROOT / "robots" / "fake.toml")
