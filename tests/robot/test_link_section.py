"""[link] of the robot file: parts that are wired the other way round."""

import pytest

from tapreach.errors import ConfigError
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription
from tapreach.robot.toml_file import parse_validated


def loaded(line, file="rover-pi"):
    text = (resource_path("robots") / f"{file}.toml").read_text(encoding="utf-8")
    assert text.count("[link]") == 1
    return parse_validated(text.replace("[link]", f"[link]\n{line}"), "own.toml", RobotDescription)


def test_parts_that_are_reversed_are_known_by_name():
    assert loaded("").link.reversed == ()
    parts = ("right_motor", "left_encoder")
    assert loaded('reversed = ["right_motor", "left_encoder"]').link.reversed == parts


@pytest.mark.parametrize(
    ("line", "file", "said"),
    [
        ('reversed = ["left"]', "rover-pi", "left_encoder"),
        ('reversed = ["left_motor", "left_motor"]', "rover-pi", "left_motor twice"),
        ("reversed = true", "rover-pi", "reversed"),
        ('reversed = ["left_motor"]', "ros-arduino", "swap the wires"),
    ],
)
def test_parts_that_nobody_could_turn_round_are_refused_with_the_line(line, file, said):
    with pytest.raises(ConfigError, match=rf"own.toml:\d+: .*{said}"):
        loaded(line, file)
