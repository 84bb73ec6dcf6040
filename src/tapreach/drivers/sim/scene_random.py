"""A furnished room out of a seed: another one for each, the same one each time."""

from collections.abc import Callable
from typing import Any

import numpy as np

from tapreach.drivers.sim.scene import Scene

Table = dict[str, Any]
_ROOM_X, _ROOM_Y = (-1.2, 3.6), (-2.0, 2.0)
_TRIES = 60


def random_scene(seed: int, objects: int = 7) -> Scene:
    """Return a scene of `objects` things in view of the robot, with furniture and light drawn at random.

    Always has a red can. What cannot be placed after some tries is left out, so there may be fewer things.
    """
    rng = np.random.default_rng([seed, 3])
    scene = Scene.model_validate(_empty_room(rng, seed))
    scene = _filled(
        scene, "furniture", [_furniture(rng) for _ in range(5)] + [_behind(rng) for _ in range(2)]
    )
    things = [_red_can(rng)] + [_thing(rng) for _ in range(objects - 1)]
    return _filled(scene, "objects", things)


def _empty_room(rng: np.random.Generator, seed: int) -> Table:
    window = {
        "kind": "window",
        "wall": "west",
        "along": rng.uniform(0.8, 2.4),
        "up": 0.35,
        "width": 1.4,
        "height": 1.6,
    }
    poster = {"kind": _one_of(rng, ["poster_mountain", "poster_shapes"]), "wall": "north", "up": 0.8,
              "along": rng.uniform(-1.4, 1.4), "width": 0.5, "height": 0.7}  # fmt: skip
    return {
        "title": f"Room of seed {seed}",
        "room": {
            "x": _ROOM_X,
            "y": _ROOM_Y,
            "floor": _one_of(rng, ["planks", "tiles", "carpet"]),
            "wall": _one_of(rng, ["wallpaper", "brick", "plain"]),
        },
        "light": {
            "ambient": rng.uniform(0.38, 0.52),
            "sun": rng.uniform(0.5, 0.72),
            "warmth": rng.uniform(-0.3, 0.6),
            "azimuth_deg": rng.uniform(90.0, 135.0),
            "elevation_deg": rng.uniform(35.0, 65.0),
        },
        "hangings": [window, poster],
    }


def _filled(scene: Scene, table: str, makers: list[Callable[[], Table]]) -> Scene:
    """Add what the makers propose, each at the first proposed place that is possible."""
    for make in makers:
        for _ in range(_TRIES):
            entries = [*scene.model_dump(exclude_unset=True).get(table, ()), make()]
            try:
                scene = Scene.model_validate({**scene.model_dump(exclude_unset=True), table: entries})
            except ValueError:
                continue
            break
    return scene


def _furniture(rng: np.random.Generator) -> Callable[[], Table]:
    kind = _one_of(rng, ["sofa", "shelf", "plant", "chair", "lamp", "table"])

    def make() -> Table:
        if rng.random() < 0.6:  # along the far wall, facing the room
            return {
                "kind": kind,
                "position": (rng.uniform(2.9, 3.3), rng.uniform(-1.6, 1.6)),
                "yaw_deg": 180.0,
            }
        side = _one_of(rng, [-1.0, 1.0])
        return {
            "kind": kind,
            "position": (rng.uniform(0.6, 2.6), side * rng.uniform(1.3, 1.7)),
            "yaw_deg": -90.0 * side,
        }

    return make


def _behind(rng: np.random.Generator) -> Callable[[], Table]:
    kind = _one_of(rng, ["shelf", "plant", "chair"])
    return lambda: {"kind": kind, "position": (rng.uniform(-1.0, -0.8), rng.uniform(-1.5, 1.5))}


def _red_can(rng: np.random.Generator) -> Callable[[], Table]:
    return lambda: {
        "kind": "can", "name": "red can", "label": "cola",
        "position": (rng.uniform(0.6, 1.5), rng.uniform(-0.25, 0.25)),
    }  # fmt: skip


def _thing(rng: np.random.Generator) -> Callable[[], Table]:
    kind = _one_of(rng, ["box", "box", "can", "bottle", "cup", "ball", "parcel"])

    def make() -> Table:
        distance = rng.uniform(0.5, 2.6)
        bearing = np.radians(rng.uniform(-26.0, 26.0))
        x, y = 0.1 + distance * np.cos(bearing), distance * np.sin(bearing)
        return {"position": (float(x), float(y)), "yaw_deg": rng.uniform(-180.0, 180.0), **_looks(rng, kind)}

    return make


def _looks(rng: np.random.Generator, kind: str) -> Table:
    if kind == "box":
        size = (*tuple(rng.uniform(0.035, 0.065, 2)), rng.uniform(0.05, 0.12))
        return {"kind": kind, "label": _one_of(rng, ["tea", "mint", "oats"]), "size": size}
    if kind == "parcel":
        size = tuple(rng.uniform(0.16, 0.34, 3))
        return {
            "kind": "box", "label": _one_of(rng, ["crate", "cardboard"]), "size": size, "mass": 1.5,
            "graspable": False,
        }  # fmt: skip
    if kind == "ball":
        return {"kind": kind, "label": _one_of(rng, ["beach", "football"])}
    labels = {"can": ["beans", "soup"], "bottle": ["juice", "water", "sauce"], "cup": ["blue", "red"]}
    return {"kind": kind, "label": _one_of(rng, labels[kind])}


def _one_of(rng: np.random.Generator, choices: list[Any]) -> Any:
    return choices[int(rng.integers(len(choices)))]
