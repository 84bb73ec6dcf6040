"""Objects of a scene as MuJoCo bodies: plain solids that the claw can grip, under a mesh that is seen."""

import math
from dataclasses import dataclass

import mujoco

from tapreach.drivers.sim.build_materials import Palette
from tapreach.drivers.sim.scene_objects import AnyObject, Ball, Bottle, Box

GEOM = mujoco.mjtGeom
UNSEEN = 3
SEEN = 1
FRICTION = (0.6, 0.003, 0.0001)
ROLLING = (0.6, 0.003, 0.0006)


@dataclass(frozen=True)
class Solid:
    """One collision solid: MuJoCo's type and size, height above the body's middle, share of mass."""

    shape: mujoco.mjtGeom
    size: tuple[float, float, float]
    z: float = 0.0
    share: float = 1.0


def add_object(spec: mujoco.MjSpec, palette: Palette, name: str, thing: AnyObject) -> None:
    """Add one free body called `name`, its origin at the middle of its height."""
    yaw = math.radians(thing.yaw_deg)
    body = spec.worldbody.add_body(
        name=name,
        pos=(*thing.position, thing.up + thing.tall / 2 + 0.0005),
        quat=(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)),
    )
    body.add_freejoint()
    is_ball = isinstance(thing, Ball)
    for solid in _solids(thing):
        body.add_geom(
            type=solid.shape, size=solid.size, pos=(0, 0, solid.z), mass=thing.weight * solid.share,
            condim=6 if is_ball else 4, friction=ROLLING if is_ball else FRICTION, group=UNSEEN,
        )  # fmt: skip
    _add_looks(spec, body, palette, name, thing)


def _solids(thing: AnyObject) -> list[Solid]:
    if isinstance(thing, Box):
        x, y, z = thing.size
        return [Solid(GEOM.mjGEOM_BOX, (x / 2, y / 2, z / 2))]
    if isinstance(thing, Ball):
        return [Solid(GEOM.mjGEOM_SPHERE, (thing.radius, 0, 0))]
    radius, height = thing.radius, thing.height
    if isinstance(thing, Bottle):
        trunk = Solid(GEOM.mjGEOM_CYLINDER, (radius, 0.35 * height, 0), -0.15 * height, 0.9)
        return [trunk, Solid(GEOM.mjGEOM_CYLINDER, (0.44 * radius, 0.15 * height, 0), 0.35 * height, 0.1)]
    return [Solid(GEOM.mjGEOM_CYLINDER, (radius, height / 2, 0))]


def _add_looks(
    spec: mujoco.MjSpec, body: mujoco.MjsBody, palette: Palette, name: str, thing: AnyObject
) -> None:
    x, y, z = thing.outer_size
    # The box's mesh has edge 2 about its middle; the turned ones have radius 1 and height 1 on their foot.
    is_box = isinstance(thing, Box)
    scale = (x / 2, y / 2, z / 2 if is_box else z)
    mesh = palette.mesh(f"{name}_mesh", thing.kind, scale)
    body.add_geom(
        type=GEOM.mjGEOM_MESH, meshname=mesh, pos=(0, 0, 0 if is_box else -z / 2), group=SEEN, mass=0,
        material=palette.surface(f"{thing.kind}_{thing.label}"), contype=0, conaffinity=0,
    )  # fmt: skip
