"""Rooms of the bench of fetching: random ones with more variety of size, looks and light than a demo needs,
and with things that cannot be grasped.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from tapreach.drivers.sim.scene import Scene, load_scene
from tapreach.drivers.sim.scene_random import random_scene

Table = dict[str, Any]
FEW, MANY = 7, 16
_FLOORS = ["planks", "tiles", "carpet", "plain", "paving"]
_WALLS = ["wallpaper", "brick", "plain", "fence"]
_LABELS = {
    "box": ["tea", "mint", "oats"],
    "can": ["cola", "beans", "soup"],
    "bottle": ["juice", "water", "sauce"],
    "cup": ["blue", "red"],
    "ball": ["beach", "football"],
}
_TRIES = 40
_CLUTTERED = "cluttered"
_EVERY_SHIPPED = 6
"""One in so many cluttered scenes is the one that ships."""


def varied_scene(rng: np.random.Generator, objects: int = FEW) -> Scene:
    """Return a random room with `objects` things, or as many as found a place, of random size and looks."""
    scene = random_scene(int(rng.integers(1 << 31)), objects)
    light = {
        "ambient": rng.uniform(0.32, 0.55),
        "sun": rng.uniform(0.45, 0.75),
        "warmth": rng.uniform(-0.5, 0.7),
        "azimuth_deg": rng.uniform(-180.0, 180.0),
        "elevation_deg": rng.uniform(25.0, 75.0),
    }
    room = {**_table(scene)["room"], "floor": one_of(rng, _FLOORS), "wall": one_of(rng, _WALLS)}
    scene = with_entries(scene, {"light": light, "room": room})
    for index in range(len(scene.objects)):
        scene = _resized(scene, index, rng)
    return scene


def cluttered_scene(rng: np.random.Generator, number: int) -> tuple[str, Scene]:
    """Return a room with many things and its name: now and then the one that ships."""
    if number % _EVERY_SHIPPED == 0:
        return _CLUTTERED, load_scene(_CLUTTERED)
    return "many things", varied_scene(rng, MANY)


def with_entries(scene: Scene, tables: Table) -> Scene:
    """Return the scene with these tables in place of its own. Raises ValueError for an impossible one."""
    return Scene.model_validate({**_table(scene), **tables})


def first_possible(scene: Scene, make: Callable[[], Table]) -> Scene | None:
    """Return the scene with the entries that `make` adds to its lists, at the first proposal that is
    possible; None when 40 are not.
    """
    table = _table(scene)
    for _ in range(_TRIES):
        added = {key: [*table.get(key, ()), *entries] for key, entries in make().items()}
        try:
            return with_entries(scene, added)
        except ValueError:
            continue
    return None


def one_of(rng: np.random.Generator, choices: list[Any]) -> Any:
    """Draw one of them."""
    return choices[int(rng.integers(len(choices)))]


def _resized(scene: Scene, index: int, rng: np.random.Generator) -> Scene:
    """Give a thing that can be grasped another size, label and heading; as it was where none fits."""
    things = list(_table(scene)["objects"])
    if not scene.objects[index].graspable:
        return scene
    kind = things[index]["kind"]
    for _ in range(_TRIES):
        looks = {"label": one_of(rng, _LABELS[kind]), "yaw_deg": rng.uniform(-180.0, 180.0)}
        things[index] = {**things[index], **looks, **_size(rng, kind)}
        try:
            return with_entries(scene, {"objects": things})
        except ValueError:
            continue
    return scene


def _size(rng: np.random.Generator, kind: str) -> Table:
    if kind == "box":
        return {"size": (*rng.uniform(0.03, 0.065, 2), rng.uniform(0.05, 0.15))}
    if kind == "ball":
        return {"radius": rng.uniform(0.022, 0.034)}
    radius, height = {
        "can": ((0.025, 0.034), (0.08, 0.13)),
        "bottle": ((0.026, 0.034), (0.15, 0.24)),
        "cup": ((0.028, 0.034), (0.07, 0.11)),
    }[kind]
    return {"radius": rng.uniform(*radius), "height": rng.uniform(*height)}


def _table(scene: Scene) -> Table:
    return scene.model_dump(exclude_unset=True)
