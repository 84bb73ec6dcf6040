from pathlib import Path
from typing import Annotated, Literal

import pytest
from pydantic import BaseModel, ConfigDict, Field, model_validator

from tapreach.errors import ConfigError
from tapreach.robot.toml_file import PlacedValueError, load_validated, parse_validated
from tapreach.robot.toml_lines import find_line


class Strict(BaseModel):
    model_config = ConfigDict(extra="forbid")


class Ball(Strict):
    kind: Literal["ball"]
    radius: float = Field(gt=0)


class Block(Strict):
    kind: Literal["block"]
    size: tuple[float, float]


class Lamp(Strict):
    power: float = 1.0


class House(Strict):
    name: str
    lamp: Lamp = Lamp()
    things: list[Annotated[Ball | Block, Field(discriminator="kind")]] = []

    @model_validator(mode="after")
    def balls_fit(self) -> "House":
        for index, thing in enumerate(self.things):
            if isinstance(thing, Ball) and thing.radius > 10:
                raise PlacedValueError("is larger than the house", "things", index, "radius")
        return self


GOOD = """
name = "home"   # = [ no key
[lamp]
power = 2.0

[[things]]
kind = "ball"
radius = 0.5

[[things]]
kind = "block"
size = [
  1.0,
  2.0,
]
"""


def fails(text: str) -> str:
    with pytest.raises(ConfigError) as caught:
        parse_validated(text, "house.toml", House)
    return str(caught.value)


def test_load_of_a_good_file(tmp_path: Path) -> None:
    path = tmp_path / "house.toml"
    path.write_text(GOOD)
    house = load_validated(path, House)
    assert house.things[1] == Block(kind="block", size=(1.0, 2.0))


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("power = 2.0", "powre = 2.0", 4, ["powre", "known keys here: power"]),
        ("radius = 0.5", "radius = -1", 8, ["things.0.radius", "greater than 0", "-1"]),
        ("radius = 0.5", "radius = 0.5\nweight = 1", 9, ["weight", "kind, radius"]),
        ("radius = 0.5", "radius = 11.0", 8, ["larger than the house", "things.0.radius"]),
        ('kind = "block"', 'kind = "blok"', 10, ["blok", "'ball', 'block'"]),
        ("size = [", "#", 12, ["not valid TOML"]),
        ('name = "home"', "", 12, []),
        ("radius = 0.5", "", 6, ["things.0.radius", "is missing", "kind, radius"]),
    ],
)
def test_fault_names_file_line_and_keys(old: str, new: str, line: int, words: list[str]) -> None:
    message = fails(GOOD.replace(old, new, 1))
    assert "house.toml" in message
    for word in words:
        assert word in message
    if words and "TOML" not in words[0]:
        assert f"house.toml:{line}: " in message


def test_missing_top_level_key_says_which() -> None:
    assert "the key 'name' is missing; known keys here: lamp, name, things" in fails("")


def test_every_fault_is_listed() -> None:
    assert len(fails(GOOD.replace("power", "pow").replace("0.5", "-1")).splitlines()) == 2


def test_missing_file_lists_its_siblings(tmp_path: Path) -> None:
    (tmp_path / "other.toml").write_text("")
    with pytest.raises(ConfigError, match=r"no such file.*other\.toml"):
        load_validated(tmp_path / "house.toml", House)


def test_binary_file_is_a_config_error(tmp_path: Path) -> None:
    path = tmp_path / "house.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="UTF-8"):
        load_validated(path, House)


def test_lines_of_nested_tables_and_inline_keys() -> None:
    text = 'a.b = 1\n[[t]]\nx = {p = 1, q = "}"}\n[t.sub]\ny = """\nz = 1\n"""\n[[t]]\n[t.sub]\ny = 2\n'
    assert find_line(text, ("a", "b")) == 1
    assert find_line(text, ("t", 0, "x", "q")) == 3
    assert find_line(text, ("t", 0, "sub", "y")) == 5
    assert find_line(text, ("t", 1, "sub", "y")) == 10
    assert find_line(text, ("t", 1, "sub", "z")) == 9
    assert find_line(text, ("absent",)) is None
