"""Objects of a scene as MuJoCo bodies: a solid that the claw can grip under a mesh that is seen."""

import math

import mujoco

from tapreach.drivers.sim.build_materials import Palette
from tapreach.drivers.sim.scene_objects import Ball, Bottle, Box, Can, Cup, RoundObject, SceneObject

GEOM = mujoco.mjtGeom
FRICTION = (0.6, 0.003, 0.0001)
ROLLING = (0.6, 0.003, 0.0006)


def add_object(spec: mujoco.MjSpec, palette: Palette, name: str, thing: SceneObject) -> None:
    """Add one free body called `name`, its origin at the middle of its height."""
    half = thing.tall / 2
    yaw = math.radians(thing.yaw_deg)
    body = spec.worldbody.add_body(
        name=name,
        pos=(*thing.position, thing.up + half + 0.0005),
        quat=(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)),
    )
    body.add_freejoint()
    if isinstance(thing, Box):
        size = [edge / 2 for edge in thing.size]
        material = palette.cube(f"box_{thing.label}")
        body.add_geom(
            name=name, type=GEOM.mjGEOM_BOX, size=size, mass=thing.weight, material=material, condim=4,
            friction=FRICTION,
        )  # fmt: skip
    elif isinstance(thing, Ball):
        _add_ball(spec, body, palette, name, thing)
    elif isinstance(thing, RoundObject):
        _add_round(spec, body, palette, name, thing)


def _add_ball(spec: mujoco.MjSpec, body: mujoco.MjsBody, palette: Palette, name: str, ball: Ball) -> None:
    body.add_geom(
        name=name, type=GEOM.mjGEOM_SPHERE, size=(ball.radius, 0, 0), mass=ball.weight, condim=6,
        friction=ROLLING, group=3,
    )  # fmt: skip
    scale = (ball.radius, ball.radius, 2 * ball.radius)
    _add_shown_mesh(spec, body, palette, name, "ball", f"ball_{ball.label}", scale)


def _add_round(
    spec: mujoco.MjSpec, body: mujoco.MjsBody, palette: Palette, name: str, thing: RoundObject
) -> None:
    """A cylinder carries the mass; a bottle has a wide and a narrow one."""
    radius, height = thing.radius, thing.height
    shares = [(1.0, 0.0, 0.7), (0.45, 0.7, 1.0)] if isinstance(thing, Bottle) else [(1.0, 0.0, 1.0)]
    for index, (width, low, high) in enumerate(shares):
        body.add_geom(
            name=f"{name}_{index}" if index else name,
            type=GEOM.mjGEOM_CYLINDER,
            size=(radius * width, height * (high - low) / 2, 0),
            pos=(0, 0, height * ((low + high) / 2 - 0.5)),
            mass=thing.weight * (0.9 if len(shares) > 1 and not index else 1.0 if len(shares) == 1 else 0.1),
            condim=4,
            friction=FRICTION,
            group=3,
        )
    kind = "can" if isinstance(thing, Can) else "cup" if isinstance(thing, Cup) else "bottle"
    label = getattr(thing, "label", "")
    _add_shown_mesh(spec, body, palette, name, kind, f"{kind}_{label}", (radius, radius, height))


def _add_shown_mesh(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    palette: Palette,
    name: str,
    mesh: str,
    texture: str,
    scale: tuple[float, float, float],
) -> None:
    spec.add_mesh(
        name=f"{name}_mesh", file=str(palette.folder / f"{mesh}.obj"), scale=scale,
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )  # fmt: skip
    geom = body.add_geom(
        name=f"{name}_shown", type=GEOM.mjGEOM_MESH, meshname=f"{name}_mesh", pos=(0, 0, -scale[2] / 2),
        material=palette.surface(texture), contype=0, conaffinity=0, group=1,
    )  # fmt: skip
    geom.mass = 0.0
