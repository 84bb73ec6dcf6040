from pathlib import Path

import pytest

from tapreach.drivers.sim.options import resolve_scene
from tapreach.drivers.sim.scene import Scene, load_scene, scene_names
from tapreach.drivers.sim.scene_random import random_scene
from tapreach.errors import ConfigError
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.toml_file import parse_validated

GOOD = """
title = "Test"
[room]
x = [-1.0, 2.0]
y = [-1.0, 1.0]

[[objects]]
kind = "can"
name = "red can"
position = [0.8, 0.0]

[[objects]]
kind = "box"
position = [1.2, 0.4]
size = [0.05, 0.05, 0.05]

[[furniture]]
kind = "shelf"
position = [1.7, -0.4]
yaw_deg = 180
"""


def message_of(text: str) -> str:
    with pytest.raises(ConfigError) as caught:
        parse_validated(text, "test.toml", Scene)
    return str(caught.value)


def test_good_scene_has_names_for_all_its_objects() -> None:
    assert parse_validated(GOOD, "test.toml", Scene).object_names() == ("red can", "box_2")


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("[-1.0, 2.0]", "[-1.0, 2.0]\nlenght = 3", 5, ["lenght", "floor, height, skirting, wall, x, y"]),
        ('kind = "can"', 'kind = "cn"', 7, ["'cn'", "'can'", "'bottle'"]),
        ("size = [0.05, 0.05, 0.05]", "size = [0.05, 0.0, 0.05]", 15, ["greater than 0", "objects.1"]),
        ("size = [0.05, 0.05, 0.05]", "size = [0.05, nan, 0.05]", 15, ["finite", "objects.1"]),
        ("size = [0.05, 0.05, 0.05]", "size = [0.05, -1, 0.05]", 15, ["greater than 0"]),
        ("size = [0.05, 0.05, 0.05]", "size = [0.2, 0.2, 0.05]", 12, ["200 mm wide", "graspable = false"]),
        ("size = [0.05, 0.05, 0.05]", "size = [0.05, 0.05, 0.04]\nmass = 2.0", 12, ["2.00 kg", "0.25 kg"]),
        ("[1.2, 0.4]", "[0.82, 0.02]", 14, ["overlaps object number 1"]),
        ("[1.2, 0.4]", "[2.4, 0.4]", 14, ["outside of the room", "-1 to 2"]),
        ("[1.2, 0.4]", "[0.1, 0.0]", 14, ["robot's start"]),
        ("[1.2, 0.4]", "[1.7, -0.8]", 14, ["overlaps the shelf"]),
        ("[1.2, 0.4]", "[1.2, 0.4]\nname = \"red can\"", 15, ["two objects", "red can"]),
        ("[1.7, -0.4]", "[1.95, -0.4]", 19, ["the shelf is outside"]),
        ("[1.7, -0.4]", "[0.1, 0.2]", 17, ["the shelf stands in the robot's start"]),
        ('"shelf"', '"lamp"\nposition = [1.6, -0.5]\n[[furniture]]\nkind = "chair"', 22, ["the lamp"]),
        ("[-1.0, 2.0]", "[0.5, 2.0]", 3, ["robot's start (0, 0)"]),
        ("[-1.0, 2.0]", "[2.0, -1.0]", 4, ["at least 0.5 m across"]),
        ('"shelf"', '"shelv"', 18, ["shelf", "sofa"]),
        ("[[objects]]", "[faults]\nslipp = 0.1\n[[objects]]", 8, ["slipp", "slip", "focal_error"]),
        ('title = "Test"', "", 1, ["title"]),
    ],
)  # fmt: skip
def test_impossible_scene_names_line_and_reason(old: str, new: str, line: int, words: list[str]) -> None:
    assert old in GOOD
    message = message_of(GOOD.replace(old, new, 1))
    for word in words:
        assert word in message
    if old != 'title = "Test"':  # a key that is missing has no line
        assert f"test.toml:{line}: " in message


def test_thing_may_stand_on_another() -> None:
    on_top = '[[objects]]\nkind = "box"\nposition = [0.8, 0.0]\nup = 0.116\nsize = [0.05, 0.05, 0.05]\n'
    assert len(parse_validated(GOOD + on_top, "test.toml", Scene).objects) == 3
    assert "overlaps" in message_of(GOOD + on_top.replace("0.116", "0.05"))


def test_shipped_scenes_cover_the_wanted_kinds() -> None:
    assert {"near", "far", "dark", "plain_floor", "cluttered", "outside", "room"} <= set(scene_names())


@pytest.mark.parametrize("name", scene_names())
def test_shipped_scene_is_valid_and_has_the_red_can_of_the_hints(name: str) -> None:
    assert "red can" in load_scene(name).object_names()


def test_unknown_scene_lists_the_known_ones() -> None:
    with pytest.raises(ConfigError, match=r"no scene 'attic'.*cluttered, dark"):
        load_scene("attic")


def test_scene_file_of_the_user_is_read_by_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(GOOD)
    assert load_scene(str(path)).title == "Test"


@pytest.mark.parametrize("seed", range(12))
def test_random_scene_is_possible_and_has_a_red_can(seed: int) -> None:
    scene = random_scene(seed)
    assert "red can" in scene.object_names()
    assert len(scene.objects) >= 5
    assert len(scene.furniture) >= 3


def test_random_scene_depends_on_its_seed_alone() -> None:
    assert random_scene(3) == random_scene(3)
    assert random_scene(3) != random_scene(4)


def robot(**simulation: object) -> RobotDescription:
    description = load_robot(resource_path("robots") / "sim.toml")
    return description.model_copy(update={"simulation": simulation})


def test_command_line_wins_over_robot_file_over_scene_file() -> None:
    file = robot(scene="dark", faults={"motion_blur_ms": 5.0, "slip": 0.1})
    scene, faults = resolve_scene(file, faults={"slip": 0.2})
    assert scene.title == "Evening"
    assert faults.exposure_noise == scene.faults.exposure_noise > 0.0
    assert (faults.motion_blur_ms, faults.slip) == (5.0, 0.2)
    assert resolve_scene(file, scene="near")[0].title == "Kitchen corner"


def test_seed_makes_a_random_scene() -> None:
    assert resolve_scene(robot(seed=3))[0] == random_scene(3)
    assert resolve_scene(robot(seed=3), scene="near")[0] == load_scene("near")
    assert resolve_scene(robot(), seed=5)[0] == random_scene(5)


def test_bad_simulation_table_names_the_known_keys() -> None:
    with pytest.raises(ConfigError, match="known keys: scene, seed, faults"):
        resolve_scene(robot(scen="dark"))
    with pytest.raises(ConfigError, match="fault 'slipp' is not known"):
        resolve_scene(robot(), faults={"slipp": 1})
    with pytest.raises(ConfigError, match="fault jpeg_quality"):
        resolve_scene(robot(), faults={"jpeg_quality": 0})
