from pathlib import Path

import pytest

from tapreach.drivers.fake import FakeRobot
from tapreach.drivers.registry import FACTORIES, factory_of, make_robot
from tapreach.errors import ConfigError
from tapreach.robot.clock import ManualClock
from tapreach.robot.config import RobotDescription, load_robot

ROOT = Path(__file__).resolve().parents[2]


def test_unknown_driver_is_refused_with_the_known_names():
    with pytest.raises(ConfigError, match=r"no driver 'tank'; known are arduino, fake, sim"):
        factory_of("tank")


@pytest.mark.parametrize("name", FACTORIES)
def test_every_listed_driver_can_be_loaded(name):
    assert callable(factory_of(name))


def test_robot_files_may_name_exactly_the_listed_drivers():
    allowed = RobotDescription.model_fields["driver"].annotation.__args__
    assert set(allowed) == set(FACTORIES)


def test_robot_file_leads_to_its_driver():
    description = load_robot(ROOT / "robots" / "fake.toml")
    assert isinstance(make_robot(description, ManualClock()), FakeRobot)
