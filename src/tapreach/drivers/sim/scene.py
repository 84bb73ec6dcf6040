"""A scene file: room, light, furniture, objects, faults. See `docs/scenes.md`."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene_checks import check_places
from tapreach.drivers.sim.scene_furniture import Furniture, Hanging
from tapreach.drivers.sim.scene_objects import Angle, AnyObject, Entry, Length
from tapreach.errors import ConfigError
from tapreach.resources import resource_path
from tapreach.robot.toml_file import PlacedValueError, load_validated

Bound = Annotated[float, Field(ge=-50.0, le=50.0, allow_inf_nan=False)]
Light01 = Annotated[float, Field(ge=0.0, le=1.5, allow_inf_nan=False)]


class Room(Entry):
    """The ground and what bounds it. The robot starts at (0, 0) looking along x."""

    x: tuple[Bound, Bound] = (-1.2, 3.2)
    y: tuple[Bound, Bound] = (-2.0, 2.0)
    height: Length = 2.4
    floor: Literal["planks", "tiles", "carpet", "plain", "paving", "grass"] = "planks"
    wall: Literal["wallpaper", "brick", "plain", "hedge", "fence"] = "wallpaper"
    skirting: bool = True

    @model_validator(mode="after")
    def _has_a_size(self) -> "Room":
        for name, (low, high) in (("x", self.x), ("y", self.y)):
            if high - low < 0.5:
                raise PlacedValueError(f"the room must be at least 0.5 m across, not {high - low:g} m", name)
        return self


class Light(Entry):
    """One sun or lamp far away, and light from all around."""

    ambient: Light01 = 0.42
    sun: Light01 = 0.6
    warmth: Annotated[float, Field(ge=-1.0, le=1.0)] = Field(0.2, description="-1 blue, 0 white, 1 candle")
    azimuth_deg: Angle = Field(60.0, description="where the light comes from: 0 ahead, 90 left")
    elevation_deg: Annotated[float, Field(ge=10.0, le=90.0)] = 55.0
    shadows: bool = True


class Scene(Entry):
    """A whole scene file."""

    title: str = Field(min_length=1)
    room: Room = Room()
    light: Light = Light()
    faults: SimFaults = SimFaults()
    furniture: tuple[Furniture, ...] = ()
    hangings: tuple[Hanging, ...] = ()
    objects: tuple[AnyObject, ...] = ()

    @model_validator(mode="after")
    def _is_possible(self) -> "Scene":
        check_places(self.room.x, self.room.y, self.furniture, self.hangings, self.objects)
        return self

    def object_names(self) -> tuple[str, ...]:
        """Return one name for each object; kind and number (from 1) where the file gives none."""
        return tuple(o.name or f"{o.kind}_{i}" for i, o in enumerate(self.objects, start=1))


def load_scene(name_or_path: str) -> Scene:
    """Read a scene that ships with the package by its name, or any scene file by its path (with `.toml`).

    Raises ConfigError naming file, line, key and what is known there, or listing the scenes that ship.
    """
    if name_or_path.endswith(".toml"):
        return load_validated(Path(name_or_path), Scene)
    path = resource_path("scenes") / f"{name_or_path}.toml"
    if not path.is_file():
        raise ConfigError(
            f"no scene {name_or_path!r}; scenes: {', '.join(scene_names())}; or give a .toml file"
        )
    return load_validated(path, Scene)


def scene_names() -> list[str]:
    """Return the names of the scenes that ship."""
    return sorted(path.stem for path in resource_path("scenes").glob("*.toml"))
