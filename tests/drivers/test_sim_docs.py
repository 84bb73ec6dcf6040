"""docs/scenes.md tells every key, and its example is a scene."""

import re
from pathlib import Path

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Light, Room, Scene
from tapreach.drivers.sim.scene_furniture import Furniture, Hanging
from tapreach.drivers.sim.scene_objects import Ball, Bottle, Box, Can, Cup
from tapreach.robot.toml_file import parse_validated

PAGE = (Path(__file__).parents[2] / "docs" / "scenes.md").read_text()


def test_example_of_the_page_is_a_scene() -> None:
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    scene = parse_validated(example, "docs/scenes.md", Scene)
    assert scene.faults.slip == 0.02


def test_page_names_every_key() -> None:
    models = (Scene, Room, Light, Furniture, Hanging, Can, Bottle, Cup, Ball, Box, SimFaults)
    keys = {key for model in models for key in model.model_fields}
    assert [key for key in sorted(keys) if not re.search(rf"\b{key}\b", PAGE)] == []
