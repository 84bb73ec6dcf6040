"""Whether the things of a scene can stand where the file puts them."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tapreach.drivers.sim.scene_furniture import Furniture, Hanging, Part
from tapreach.drivers.sim.scene_objects import Box, SceneObject
from tapreach.robot.toml_file import PlacedValueError

Interval = tuple[float, float]
Corners = NDArray[np.float64]


@dataclass(frozen=True)
class Solid:
    """An upright prism [m]: convex outline (n, 2), counter-clockwise, and its height interval."""

    outline: Corners
    height: Interval

    def overlaps(self, other: "Solid") -> bool:
        """True when the two share more than touching surfaces (1 mm is forgiven)."""
        slack = 1e-3
        apart_in_height = self.height[1] - other.height[0] < slack or other.height[1] - self.height[0] < slack
        return not apart_in_height and not _is_separable(self.outline, other.outline, slack)


ROBOT_AT_START = Solid(np.array([[-0.17, -0.11], [0.21, -0.11], [0.21, 0.11], [-0.17, 0.11]]), (0.0, 0.40))


def check_places(
    room_x: Interval,
    room_y: Interval,
    furniture: Sequence[Furniture],
    hangings: Sequence[Hanging],
    objects: Sequence[SceneObject],
) -> None:
    """Raise PlacedValueError for the first thing that is outside of the room or inside something else."""
    if not (room_x[0] < -0.3 and room_x[1] > 0.3 and room_y[0] < -0.3 and room_y[1] > 0.3):
        raise PlacedValueError("the robot's start (0, 0) must lie at least 0.3 m inside of the room", "room")
    pieces = [[solid_of_part(piece, part) for part in piece.parts() if part.is_solid] for piece in furniture]
    _check_hangings(room_x, room_y, hangings)
    for index, piece in enumerate(furniture):
        for solid in pieces[index]:
            _check_inside(solid, room_x, room_y, f"the {piece.kind}", "furniture", index)
            if solid.overlaps(ROBOT_AT_START):
                raise PlacedValueError(f"the {piece.kind} stands in the robot's start", "furniture", index)
    for first, second in combinations(range(len(furniture)), 2):
        if any(a.overlaps(b) for a in pieces[first] for b in pieces[second]):
            one, other = furniture[first], furniture[second]
            message = f"the {other.kind} overlaps the {one.kind} at {one.position}"
            raise PlacedValueError(message, "furniture", second, "position")
    _check_objects(room_x, room_y, furniture, pieces, objects)


def solid_of_object(thing: SceneObject) -> Solid:
    """Return the space that an object takes."""
    height = (thing.up, thing.up + thing.tall)
    if isinstance(thing, Box):
        return Solid(_rectangle(thing.size[0] / 2, thing.size[1] / 2, thing.yaw_deg, thing.position), height)
    return Solid(_circle(thing.width / 2, thing.position), height)


def solid_of_part(piece: Furniture, part: Part) -> Solid:
    """Return the space that a part of a piece of furniture takes in the room."""
    x, y = _turned(np.array([part.centre[:2]]), piece.yaw_deg)[0] + piece.position
    half_height = part.half[1] if part.shape == "cylinder" else part.half[2]
    height = (part.centre[2] - half_height, part.centre[2] + half_height)
    if part.shape == "box":
        return Solid(_rectangle(part.half[0], part.half[1], piece.yaw_deg, (x, y)), height)
    return Solid(_circle(part.half[0], (x, y)), height)


def _check_objects(
    room_x: Interval,
    room_y: Interval,
    furniture: Sequence[Furniture],
    pieces: list[list[Solid]],
    objects: Sequence[SceneObject],
) -> None:
    solids = [solid_of_object(thing) for thing in objects]
    for index, solid in enumerate(solids):
        _check_inside(solid, room_x, room_y, "the object", "objects", index)
        if solid.overlaps(ROBOT_AT_START):
            raise PlacedValueError("the object stands in the robot's start", "objects", index, "position")
        for piece, parts in zip(furniture, pieces, strict=True):
            if any(solid.overlaps(part) for part in parts):
                message = f"the object overlaps the {piece.kind} at {piece.position}"
                raise PlacedValueError(message, "objects", index, "position")
    for first, second in combinations(range(len(solids)), 2):
        if solids[first].overlaps(solids[second]):
            message = f"the object overlaps object number {first + 1} at {objects[first].position}"
            raise PlacedValueError(message, "objects", second, "position")
    names = [thing.name for thing in objects]
    for index, name in enumerate(names):
        if name and name in names[:index]:
            raise PlacedValueError(f"two objects have the name {name!r}", "objects", index, "name")


def _check_hangings(room_x: Interval, room_y: Interval, hangings: Sequence[Hanging]) -> None:
    for index, hanging in enumerate(hangings):
        low, high = room_y if hanging.wall in ("north", "south") else room_x
        if hanging.along - hanging.width / 2 < low or hanging.along + hanging.width / 2 > high:
            message = f"the {hanging.kind} reaches beyond its wall, which runs from {low:g} to {high:g} m"
            raise PlacedValueError(message, "hangings", index, "along")


def _check_inside(
    solid: Solid, room_x: Interval, room_y: Interval, what: str, table: str, index: int
) -> None:
    for axis, (name, (low, high)) in enumerate((("x", room_x), ("y", room_y))):
        least, most = solid.outline[:, axis].min(), solid.outline[:, axis].max()
        if least < low - 1e-6 or most > high + 1e-6:
            message = (
                f"{what} is outside of the room: {name} {least:.2f} to {most:.2f} m, room {low:g} to {high:g}"
            )
            raise PlacedValueError(message, table, index, "position")


def _is_separable(first: Corners, second: Corners, slack: float) -> bool:
    low, high = np.maximum(first.min(axis=0), second.min(axis=0)), np.minimum(first.max(0), second.max(0))
    if bool((high - low < slack).any()):  # quick, and true of most
        return True
    for outline in (first, second):
        edges = np.roll(outline, -1, axis=0) - outline
        normals = np.column_stack([edges[:, 1], -edges[:, 0]])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        a, b = first @ normals.T, second @ normals.T
        depth = np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0))
        if bool((depth < slack).any()):
            return True
    return False


def _rectangle(half_x: float, half_y: float, yaw_deg: float, centre: tuple[float, float]) -> Corners:
    corners = np.array([[half_x, half_y], [-half_x, half_y], [-half_x, -half_y], [half_x, -half_y]])
    return _turned(corners, yaw_deg) + centre


def _circle(radius: float, centre: tuple[float, float], corners: int = 16) -> Corners:
    angles = np.arange(corners) * 2 * np.pi / corners
    return radius * np.column_stack([np.cos(angles), np.sin(angles)]) + centre


def _turned(points: Corners, yaw_deg: float) -> Corners:
    c, s = np.cos(np.radians(yaw_deg)), np.sin(np.radians(yaw_deg))
    return np.asarray(points @ np.array([[c, s], [-s, c]]))
