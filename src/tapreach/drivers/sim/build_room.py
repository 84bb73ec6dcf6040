"""Ground, walls, hangings, furniture and light of a scene as MuJoCo geoms."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from tapreach.drivers.sim.build_materials import Palette
from tapreach.drivers.sim.scene import Light, Room
from tapreach.drivers.sim.scene_furniture import Furniture, Hanging, Part

GEOM = mujoco.mjtGeom
# How often a texture repeats per metre.
FLOOR_REPEAT = {"planks": 0.625, "tiles": 0.75, "carpet": 1.2, "plain": 0.5, "paving": 0.55, "grass": 1.0}
WALL_REPEAT = {"wallpaper": 1.4, "brick": 0.9, "plain": 0.5, "hedge": 1.3, "fence": 1.0}
WALL_TEXTURE = {"hedge": "leaves", "fence": "bark"}
SKIRTING_HEIGHT = 0.09
_SHAPES = {"box": GEOM.mjGEOM_BOX, "cylinder": GEOM.mjGEOM_CYLINDER, "ellipsoid": GEOM.mjGEOM_ELLIPSOID}


@dataclass(frozen=True)
class Wall:
    """One wall: middle of its foot and length [m]; unit directions along it and into the room."""

    foot: tuple[float, float]
    length: float
    along: tuple[float, float]
    inward: tuple[float, float]

    def quat_wxyz(self) -> list[float]:
        """Return the turn that lays local x along the wall and local z into the room."""
        up = np.array([0.0, 0.0, 1.0])
        x = np.array([*self.along, 0.0])
        matrix = np.column_stack([x, np.cross([*self.inward, 0.0], x), [*self.inward, 0.0]])
        if matrix[2, 1] < 0:  # pictures must stand upright
            matrix = np.column_stack([-x, up, [*self.inward, 0.0]])
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, matrix.flatten())
        return [float(q) for q in quat]

    def point(self, along: float, off: float, up: float) -> tuple[float, float, float]:
        """Return the point `along` the wall from its middle, `off` it into the room, `up` above the floor."""
        x = self.foot[0] + along * self.along[0] + off * self.inward[0]
        return (x, self.foot[1] + along * self.along[1] + off * self.inward[1], up)


def walls_of(room: Room) -> dict[str, Wall]:
    """Return the four walls by name."""
    (x0, x1), (y0, y1) = room.x, room.y
    xm, ym = (x0 + x1) / 2, (y0 + y1) / 2
    return {
        "north": Wall((x1, ym), y1 - y0, (0, 1), (-1, 0)),
        "south": Wall((x0, ym), y1 - y0, (0, 1), (1, 0)),
        "west": Wall((xm, y1), x1 - x0, (1, 0), (0, -1)),
        "east": Wall((xm, y0), x1 - x0, (1, 0), (0, 1)),
    }


def add_room(spec: mujoco.MjSpec, palette: Palette, room: Room) -> None:
    """Add floor and walls. Outside (hedge, fence) the ground runs on beyond them."""
    outside = room.wall in WALL_TEXTURE
    half = 20.0 if outside else max(room.x[1] - room.x[0], room.y[1] - room.y[0])
    repeat = FLOOR_REPEAT[room.floor]
    spec.worldbody.add_geom(
        name="floor", type=GEOM.mjGEOM_PLANE, size=(half, half, 0.1), castshadow=False, condim=4,
        material=palette.surface(room.floor, (repeat, repeat), per_metre=True), friction=(0.8, 0.005, 0.0001),
    )  # fmt: skip
    texture, repeat = WALL_TEXTURE.get(room.wall, room.wall), WALL_REPEAT[room.wall]
    height = {"hedge": 1.1, "fence": 0.9}.get(room.wall, room.height)
    for name, wall in walls_of(room).items():
        _add_slab(spec, wall, f"wall_{name}", wall.length, height, 0.0, 0.0, -0.05, 0.1,
                  palette.surface(texture, (repeat, repeat), per_metre=True), solid=True)  # fmt: skip
        if room.skirting and not outside:
            _add_slab(spec, wall, f"skirting_{name}", wall.length, SKIRTING_HEIGHT, 0.0, 0.0, 0.006, 0.012,
                      palette.flat("#ece7db"))  # fmt: skip
            _add_slab(spec, wall, f"bead_{name}", wall.length, 0.008, 0.0, SKIRTING_HEIGHT, 0.003, 0.006,
                      palette.flat("#8d8474"))  # fmt: skip


def add_hanging(spec: mujoco.MjSpec, palette: Palette, room: Room, index: int, hanging: Hanging) -> None:
    """Add a window, door or poster with its frame."""
    wall = walls_of(room)[hanging.wall]
    name = f"hanging_{index}"
    middle = wall.foot[1] if hanging.wall in ("north", "south") else wall.foot[0]
    along = hanging.along - middle
    glows = {"window": 0.75, "door": 0.0}.get(hanging.kind, 0.0)
    texture = "view" if hanging.kind == "window" else hanging.kind
    material = palette.glowing(texture, glows) if glows else palette.surface(texture)
    _add_slab(spec, wall, name, hanging.width, hanging.height, along, hanging.up, 0.008, 0.016, material)
    rail = 0.06 if hanging.kind in ("window", "door") else 0.018
    paint = palette.flat("#f2efe8" if rail > 0.03 else "#2e2a26")
    sides = [-hanging.width / 2, hanging.width / 2]
    for number, offset in enumerate([*sides, 0.0] if hanging.kind == "window" else sides):
        _add_slab(
            spec,
            wall,
            f"{name}_post_{number}",
            rail,
            hanging.height,
            along + offset,
            hanging.up,
            0.015,
            0.034,
            paint,
        )
    for number, share in enumerate((0.0, 0.5, 1.0) if hanging.kind == "window" else (0.0, 1.0)):
        up = hanging.up + share * hanging.height - rail / 2
        _add_slab(
            spec, wall, f"{name}_rail_{number}", hanging.width + rail, rail, along, up, 0.016, 0.034, paint
        )


def add_sun_patches(
    spec: mujoco.MjSpec, palette: Palette, room: Room, light: Light, hanging: Hanging
) -> None:
    """Lay the sunlight of a window's four panes on the floor, where the sun stands outside of it."""
    wall = walls_of(room)[hanging.wall]
    azimuth, elevation = math.radians(light.azimuth_deg), math.radians(light.elevation_deg)
    entering = -(math.cos(azimuth) * wall.inward[0] + math.sin(azimuth) * wall.inward[1])
    if hanging.kind != "window" or not light.shadows or light.sun < 0.3 or entering < 0.2:
        return
    middle = wall.foot[1] if hanging.wall in ("north", "south") else wall.foot[0]
    reach = np.array([-math.cos(azimuth), -math.sin(azimuth)]) / math.tan(elevation)
    half, tall = hanging.width / 2, hanging.height / 2
    for pane, (side, up) in enumerate(((-half, 0.0), (0.0, 0.0), (-half, tall), (0.0, tall))):
        corners = []
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            along = hanging.along - middle + side + 0.04 + s * (half - 0.08)
            x, y, z = wall.point(along, 0.02, hanging.up + up + 0.04 + t * (tall - 0.08))
            corners.append((x + z * reach[0], y + z * reach[1]))
        _add_patch(spec, palette, f"sun_{hanging.wall}_{hanging.along:g}_{pane}", corners)


def _add_patch(spec: mujoco.MjSpec, palette: Palette, name: str, corners: list[tuple[float, float]]) -> None:
    """Add a thin bright see-through plate on the floor."""
    points = [(x, y, z) for z in (0.003, 0.0035) for x, y in corners]
    spec.add_mesh(name=name, uservert=np.array(points).flatten())
    spec.worldbody.add_geom(
        name=name, type=GEOM.mjGEOM_MESH, meshname=name, material=palette.flat("#ffe6a834", emission=0.8),
        castshadow=False, contype=0, conaffinity=0,
    )  # fmt: skip


def _add_slab(
    spec: mujoco.MjSpec, wall: Wall, name: str, width: float, height: float, along: float, up: float,
    off: float, thick: float, material: str, solid: bool = False,
) -> None:  # fmt: skip
    spec.worldbody.add_geom(
        name=name, type=GEOM.mjGEOM_BOX, size=(width / 2, height / 2, thick / 2),
        pos=wall.point(along, off, up + height / 2), quat=wall.quat_wxyz(), material=material,
        castshadow=False, contype=int(solid), conaffinity=int(solid),
    )  # fmt: skip


def add_furniture(spec: mujoco.MjSpec, palette: Palette, index: int, piece: Furniture) -> None:
    """Add one piece as a body that does not move."""
    yaw = math.radians(piece.yaw_deg)
    body = spec.worldbody.add_body(
        name=f"{piece.kind}_{index}",
        pos=(*piece.position, 0),
        quat=(math.cos(yaw / 2), 0, 0, math.sin(yaw / 2)),
    )
    for number, part in enumerate(piece.parts()):
        is_books = part.paint == "books"
        if is_books:  # their texture must stand upright, as only a mesh can tell
            palette.mesh(f"books_{index}_{number}", "box", part.half)
        body.add_geom(
            type=GEOM.mjGEOM_MESH if is_books else _SHAPES[part.shape], size=part.half, pos=part.centre,
            meshname=f"books_{index}_{number}" if is_books else "", material=_paint(palette, part),
            contype=int(part.is_solid), conaffinity=int(part.is_solid), castshadow=not part.is_flat,
        )  # fmt: skip


def _paint(palette: Palette, part: Part) -> str:
    if part.paint.startswith("#"):
        return palette.flat(part.paint, emission=0.6 if part.paint == "#ffe9b8" else 0.0)
    if part.paint in ("rug", "books"):
        return palette.surface(part.paint)
    if part.paint == "paving":
        return palette.surface("paving", (0.55, 0.55), per_metre=True)
    return palette.cube(part.paint)


def add_light(spec: mujoco.MjSpec, light: Light, is_outside: bool) -> None:
    """Add the sun (or lamp), the light from all around and the sky."""
    azimuth, elevation = math.radians(light.azimuth_deg), math.radians(light.elevation_deg)
    towards = np.array(
        [
            math.cos(elevation) * math.cos(azimuth),
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
        ]
    )
    tint = np.array([1.0 + 0.12 * light.warmth, 1.0, 1.0 - 0.22 * light.warmth])
    spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=np.array([0.6, 0.0, 0.0]) + 2.0 * towards,
        dir=-towards,
        diffuse=np.clip(light.sun * tint, 0, 1),
        specular=np.full(3, 0.25 * light.sun),
        ambient=np.zeros(3),
        castshadow=light.shadows,
    )
    head = spec.visual.headlight
    head.ambient = np.full(3, light.ambient)
    head.diffuse = np.full(3, 0.3 * light.ambient)
    head.specular = np.zeros(3)
    shine = min(1.0, 0.25 + light.ambient + 0.4 * light.sun)
    above, below = (
        ((0.30, 0.50, 0.82), (0.80, 0.87, 0.93)) if is_outside else ((0.88, 0.87, 0.84), (0.8, 0.79, 0.76))
    )
    spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=np.array(above) * shine, rgb2=np.array(below) * shine, width=64, height=384,
    )  # fmt: skip
