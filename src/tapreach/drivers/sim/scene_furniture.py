"""What makes a scene a place: furniture as lists of plain parts, and things that hang on walls."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from tapreach.drivers.sim.scene_objects import Angle, Entry, Length, Place

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Part:
    """One solid of a piece of furniture, in the piece's own frame (origin on the floor, z up) [m].

    shape: "box" or "ellipsoid" (half sizes), "cylinder" (radius, half height, unused). paint: a texture name,
    or "#rrggbb". is_solid: things collide with it.
    """

    shape: Literal["box", "cylinder", "ellipsoid"]
    half: Vector
    centre: Vector
    paint: str
    is_solid: bool = True

    @property
    def is_flat(self) -> bool:
        """True for what lies on the floor and throws no shadow."""
        return self.shape == "box" and self.half[2] < 0.002


class Furniture(Entry):
    """A piece that stands on the floor and does not move."""

    kind: Literal[
        "table", "chair", "shelf", "sofa", "plant", "rug", "bench", "tree", "planter", "lamp", "path"
    ]
    position: tuple[Place, Place]
    yaw_deg: Angle = 0.0
    size: tuple[Length, Length, Length] | None = Field(
        None, description="along its x (front), its y (width) and up [m]; a usual one when left out"
    )

    def parts(self) -> list[Part]:
        """Return the solids it is made of."""
        usual, build = _KINDS[self.kind]
        return list(build(*(self.size or usual)))


class Hanging(Entry):
    """A picture, window or door on a wall of the room."""

    kind: Literal["window", "door", "poster_mountain", "poster_shapes"]
    wall: Literal["north", "south", "west", "east"] = Field(
        description="north: at the far end of x; west: at the far end of y; seen from the middle of the room"
    )
    along: Place = Field(
        description="place of its middle along the wall: y (north, south) or x (west, east) [m]"
    )
    up: Annotated[float, Field(ge=0.0, le=3.0)] = Field(0.0, description="lower edge above the floor [m]")
    width: Length = 0.9
    height: Length = 2.0


def box(size: Vector, centre: Vector, paint: str, is_solid: bool = True) -> Part:
    """Return a box of whole `size`."""
    return Part("box", (size[0] / 2, size[1] / 2, size[2] / 2), centre, paint, is_solid)


def _legs(deep: float, wide: float, tall: float, thick: float, paint: str) -> Iterator[Part]:
    x, y = deep / 2 - thick, wide / 2 - thick
    for sx, sy in ((x, y), (x, -y), (-x, y), (-x, -y)):
        yield box((thick, thick, tall), (sx, sy, tall / 2), paint)


def _table(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield from _legs(deep, wide, tall - 0.03, 0.05, "wood")
    yield box((deep, wide, 0.03), (0, 0, tall - 0.015), "wood")
    yield box((deep - 0.12, wide - 0.12, 0.08), (0, 0, tall - 0.07), "wood", is_solid=False)


def _chair(deep: float, wide: float, tall: float) -> Iterator[Part]:
    seat = 0.5 * tall
    yield from _legs(deep, wide, seat - 0.04, 0.04, "bark")
    yield box((deep, wide, 0.05), (0, 0, seat - 0.015), "fabric")
    for y in (-wide / 2 + 0.04, wide / 2 - 0.04):
        yield box((0.035, 0.04, tall - seat), (-deep / 2 + 0.02, y, (tall + seat) / 2), "bark")
    for share in (0.45, 0.85):
        yield box((0.025, wide - 0.1, 0.07), (-deep / 2 + 0.02, 0, seat + share * (tall - seat)), "bark")
    yield box((0.02, wide - 0.1, 0.03), (deep / 2 - 0.04, 0, 0.3 * seat), "bark")


def _shelf(deep: float, wide: float, tall: float) -> Iterator[Part]:
    for y in (-wide / 2 + 0.012, wide / 2 - 0.012):
        yield box((deep, 0.024, tall), (0, y, tall / 2), "wood")
    yield box((0.012, wide, tall), (-deep / 2 + 0.006, 0, tall / 2), "wood")
    boards = max(2, round(tall / 0.34))
    for index in range(boards + 1):
        z = 0.05 + index * (tall - 0.07) / boards
        yield box((deep, wide - 0.04, 0.022), (0, 0, z), "wood")
        if index < boards:
            high = 0.74 * (tall - 0.07) / boards
            side = 1 if index % 2 else -1
            yield box(
                (0.6 * deep, 0.62 * wide, high), (-0.1 * deep, side * 0.15 * wide, z + high / 2), "books"
            )


def _sofa(deep: float, wide: float, tall: float) -> Iterator[Part]:
    seat = 0.5 * tall
    yield from _legs(deep, wide, 0.09, 0.05, "bark")
    yield box((deep, wide, seat - 0.12), (0, 0, 0.09 + (seat - 0.12) / 2), "fabric")
    for y in (-wide * 0.22, wide * 0.22):
        yield box((deep * 0.72, wide * 0.42, 0.12), (deep * 0.11, y, seat + 0.03), "fabric", is_solid=False)
    yield box((deep * 0.24, wide, tall - seat), (-deep * 0.38, 0, (tall + seat) / 2), "fabric")
    for y in (-wide / 2 + 0.08, wide / 2 - 0.08):
        yield box((deep, 0.16, 0.7 * tall - 0.09), (0, y, 0.09 + (0.7 * tall - 0.09) / 2), "fabric")


def _plant(deep: float, wide: float, tall: float) -> Iterator[Part]:
    radius, pot = min(deep, wide) / 2, 0.36 * tall
    yield Part("cylinder", (0.62 * radius, pot / 2, 0), (0, 0, pot / 2), "#b4643f")
    yield Part("cylinder", (0.70 * radius, 0.014, 0), (0, 0, pot - 0.014), "#c2714a")
    yield Part("cylinder", (0.03, 0.12 * tall, 0), (0, 0, pot + 0.1 * tall), "bark", is_solid=False)
    for dx, dy, z, size in (
        (0.25, 0.1, 0.62, 0.62),
        (-0.3, 0.2, 0.66, 0.6),
        (0.0, -0.3, 0.64, 0.6),
        (0, 0, 0.82, 0.7),
    ):
        half = (size * radius, size * radius, 0.17 * tall)
        yield Part("ellipsoid", half, (dx * radius, dy * radius, z * tall), "leaves", is_solid=False)


def _rug(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield box((deep, wide, 0.002), (0, 0, 0.001), "rug", is_solid=False)


def _path(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield box((deep, wide, 0.002), (0, 0, 0.001), "paving", is_solid=False)


def _bench(deep: float, wide: float, tall: float) -> Iterator[Part]:
    for y in (-0.42 * wide, 0.42 * wide):
        yield box((0.9 * deep, 0.06, 0.9 * tall), (0, y, 0.45 * tall), "#4a4c50")
    for index in range(4):
        x = (index - 1.5) * deep / 4
        yield box((deep / 4 - 0.02, wide, 0.035), (x, 0, tall - 0.018), "wood")


def _tree(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield Part("cylinder", (0.09, 0.3 * tall, 0), (0, 0, 0.3 * tall), "bark")
    for dx, dy, z, size in (
        (0.2, 0, 0.66, 0.8),
        (-0.2, 0.3, 0.72, 0.8),
        (-0.1, -0.3, 0.7, 0.8),
        (0, 0, 0.86, 0.7),
    ):
        half = (size * deep / 2, size * wide / 2, 0.18 * tall)
        yield Part("ellipsoid", half, (dx * deep, dy * wide, z * tall), "leaves", is_solid=False)


def _planter(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield box((deep, wide, 0.55 * tall), (0, 0, 0.275 * tall), "wood")
    yield box((0.94 * deep, 0.94 * wide, 0.4 * tall), (0, 0, 0.72 * tall), "leaves")


def _lamp(deep: float, wide: float, tall: float) -> Iterator[Part]:
    yield Part("cylinder", (0.14, 0.012, 0), (0, 0, 0.012), "#2b2b2e")
    yield Part("cylinder", (0.012, 0.42 * tall, 0), (0, 0, 0.42 * tall), "#2b2b2e")
    yield Part("cylinder", (0.17, 0.11, 0), (0, 0, 0.88 * tall), "#ffe9b8", is_solid=False)


_KINDS = {
    "table": ((0.8, 1.3, 0.74), _table),
    "chair": ((0.42, 0.42, 0.88), _chair),
    "shelf": ((0.3, 0.9, 1.5), _shelf),
    "sofa": ((0.8, 1.7, 0.78), _sofa),
    "plant": ((0.36, 0.36, 0.8), _plant),
    "rug": ((1.2, 1.8, 0.01), _rug),
    "path": ((1.2, 6.0, 0.01), _path),
    "bench": ((0.42, 1.4, 0.45), _bench),
    "tree": ((1.6, 1.6, 2.6), _tree),
    "planter": ((0.4, 1.2, 0.5), _planter),
    "lamp": ((0.34, 0.34, 1.5), _lamp),
}
