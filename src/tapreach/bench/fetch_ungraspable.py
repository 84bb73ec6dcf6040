"""Things that cannot be fetched, each for a reason of its own, put into a random room."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

import numpy as np

from tapreach.bench.fetch_scene import Table, first_possible, one_of, varied_scene
from tapreach.bench.places import Sought
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.scene_furniture import Hanging
from tapreach.errors import SetupError
from tapreach.geometry.finite import FloatArray

_OTHERS = 4
_LEAST_WIDE = 0.105
"""A claw of 73 mm does not take it, from whatever side [m]."""
_LEAST_HIGH = 0.37
"""No arm of 0.24 m on a shoulder at 0.12 m takes what begins there [m]."""
_ROOMS = 30


class Hindrance(StrEnum):
    """Why something cannot be fetched."""

    WIDE = "too wide"
    HIGH = "too high"
    PICTURE = "a picture on the wall"


TRUE_REASONS = {
    Hindrance.WIDE: ("too wide",),
    Hindrance.HIGH: ("too high", "stands on something"),
    Hindrance.PICTURE: ("too wide", "too high", "stands on something", "wall", "flat thing"),
}
"""One of these words is in what is truly said of it."""


@dataclass(frozen=True)
class Ungraspable:
    """A scene, and what is tapped in it."""

    hindrance: Hindrance
    scene: Scene
    sought: Sought


def ungraspable(rng: np.random.Generator, hindrance: Hindrance) -> Ungraspable:
    """Return a room with such a thing in it. Raises SetupError when no room has a place for it."""
    for _ in range(_ROOMS):
        room = varied_scene(rng, _OTHERS)
        scene = first_possible(room, partial(_MAKERS[hindrance], rng, room))
        if scene is not None:
            return Ungraspable(hindrance, scene, _sought(scene, hindrance))
    raise SetupError(f"no random room has a place for something that is {hindrance}")


def _sought(scene: Scene, hindrance: Hindrance) -> Sought:
    if hindrance is Hindrance.PICTURE:
        corners = corners_in_world(scene, scene.hangings[-1])
        x, y = corners[:, :2].mean(axis=0)
        return Sought("", (float(x), float(y)), corners)
    return Sought(scene.object_names()[-1], scene.objects[-1].position)


def corners_in_world(scene: Scene, hanging: Hanging) -> FloatArray:
    """Return the corners (4, 3) [m] of what hangs on a wall."""
    along = hanging.along + hanging.width * np.array([-0.5, 0.5, 0.5, -0.5])
    up = hanging.up + hanging.height * np.array([0.0, 0.0, 1.0, 1.0])
    if hanging.wall in ("north", "south"):
        wall = scene.room.x[1] if hanging.wall == "north" else scene.room.x[0]
        return np.column_stack([np.full(4, wall), along, up])
    wall = scene.room.y[1] if hanging.wall == "west" else scene.room.y[0]
    return np.column_stack([along, np.full(4, wall), up])


def _wide(rng: np.random.Generator, room: Scene) -> Table:
    if rng.random() < 0.3:
        radius, height = rng.uniform(0.5 * _LEAST_WIDE, 0.09), rng.uniform(0.08, 0.2)
        drum = {"kind": "can", "label": "soup", "radius": radius, "height": height, "graspable": False}
        return {"objects": [{**drum, "position": _place(rng)}]}
    size = (*rng.uniform(_LEAST_WIDE, 0.34, 2), rng.uniform(0.06, 0.3))
    return {"objects": [_parcel(rng, size, _place(rng))]}


def _high(rng: np.random.Generator, room: Scene) -> Table:
    """Propose a can or a packet on a crate or a low table."""
    x, y = _place(rng)
    up, on_top = rng.uniform(_LEAST_HIGH, 0.45), one_of(rng, ["can", "cup", "box"])
    thing = {"kind": on_top, "position": (x, y), "up": up + 0.001, "name": "the high thing"}
    if on_top == "box":
        thing |= {"size": (0.05, 0.05, 0.08), "label": "tea"}
    if rng.random() < 0.5:
        crate = _parcel(rng, (*rng.uniform(0.18, 0.3, 2), up), (x, y))
        return {"objects": [crate, thing]}
    size = (0.4, 0.5, up)
    return {"furniture": [{"kind": "table", "position": (x, y), "size": size}], "objects": [thing]}


def _picture(rng: np.random.Generator, room: Scene) -> Table:
    wall = one_of(rng, ["north", "south", "west", "east"])
    low, high = room.room.y if wall in ("north", "south") else room.room.x
    hanging = {
        "kind": one_of(rng, ["poster_mountain", "poster_shapes"]),
        "wall": wall,
        "along": rng.uniform(low + 0.4, high - 0.4),
        "up": rng.uniform(0.1, 0.4),
        "width": rng.uniform(0.15, 0.5),
        "height": rng.uniform(0.2, 0.5),
    }
    return {"hangings": [hanging]}


_MAKERS: dict[Hindrance, Callable[[np.random.Generator, Scene], Table]] = {
    Hindrance.WIDE: _wide,
    Hindrance.HIGH: _high,
    Hindrance.PICTURE: _picture,
}


def _parcel(rng: np.random.Generator, size: tuple[float, ...], place: tuple[float, float]) -> Table:
    return {
        "kind": "box",
        "label": one_of(rng, ["crate", "cardboard"]),
        "size": size,
        "position": place,
        "yaw_deg": rng.uniform(-180.0, 180.0),
        "mass": 1.5,
        "graspable": False,
    }


def _place(rng: np.random.Generator) -> tuple[float, float]:
    return float(rng.uniform(0.7, 2.6)), float(rng.uniform(-1.2, 1.2))
