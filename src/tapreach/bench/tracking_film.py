"""A film of one motion through one scene: pictures, odometry, and where tapped points truly are in them."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tapreach.bench.tracking_motions import Motion, legs_of, poses_along, steps_of
from tapreach.drivers.sim.stage import Hit, Stage
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription

NEAREST, FARTHEST = 0.35, 3.2
_FROM, _LEVER, _TRIES = 2.5, 0.1, 400
_AROUND = tuple((4.0 * math.cos(a), 4.0 * math.sin(a)) for a in np.arange(8) * math.pi / 4.0)
_MARGIN = 14
"""A point this near to the picture's edge [px] need not be followed."""
_SLANTED = math.cos(math.radians(75.0))
"""Nor one whose surface is seen at a flatter angle than this."""


@dataclass(frozen=True, eq=False)
class Tapped:
    """A tapped surface point: its pixel in the first picture, and in each picture the true pixel (2,),
    whether it can be seen there, and its depth [m].
    """

    pixel: Pixel
    pixels: FloatArray
    is_visible: NDArray[np.bool_]
    depths: FloatArray


@dataclass(frozen=True, eq=False)
class Film:
    """odometry: world_from_base of each picture as the wheels tell it."""

    motion: Motion
    scene: str
    jpegs: tuple[bytes, ...]
    odometry: tuple[PlanarPose, ...]
    taps: tuple[Tapped, ...]


def shoot(
    stage: Stage,
    scene: str,
    motion: Motion,
    taps: int,
    description: RobotDescription,
    rng: np.random.Generator,
) -> Film | None:
    """Return a film with up to `taps` tapped points; None where the scene has no room for the motion."""
    found = _approach(stage, rng) if motion is Motion.APPROACH else (PlanarPose(), None)
    if found is None:
        return None
    start, wanted = found
    steps = list(steps_of(legs_of(motion, rng)))
    poses = poses_along(start, steps)
    taken = [stage.picture(before, now) for before, now in zip([poses[0], *poses], poses, strict=False)]
    hits = _tapped_hits(stage, taken[0][1], wanted, taps, description, rng)
    if not hits:
        return None
    slip = rng.uniform(0.0, 0.02, 2)
    turned, driven = 1.0 + rng.normal(0.0, 0.01, 2) + slip
    odometry = poses_along(start, steps, float(turned), float(driven))
    tapped = _truths(stage, [state for _, state in taken], hits, description)
    return Film(motion, scene, tuple(jpeg for jpeg, _ in taken), tuple(odometry), tapped)


def _tapped_hits(
    stage: Stage,
    state: NDArray[np.float64],
    wanted: str | None,
    count: int,
    description: RobotDescription,
    rng: np.random.Generator,
) -> list[Hit]:
    """Draw pixels until `count` of them lie on objects, or on the wanted one."""
    lens = _lens(stage, state, description)
    stage.place(state)
    hits: list[Hit] = []
    names = stage.objects if wanted is None else (wanted,)
    width, height = description.camera.width, description.camera.height
    for u, v in rng.uniform((20.0, 20.0), (width - 20.0, height - 20.0), (600 * count, 2)):
        hit = lens(u, v)
        if hit is None or hit.body not in names or not is_within_outline(lens, u, v, hit.body):
            continue
        if NEAREST < float(np.linalg.norm(hit.point - stage.camera_pose(state)[0].translation)) < FARTHEST:
            hits.append(hit)
        if len(hits) == count:
            break
    return hits


def _lens(
    stage: Stage, state: NDArray[np.float64], description: RobotDescription
) -> Callable[[float, float], Hit | None]:
    """Return what tells the thing under a pixel of the picture taken in `state`."""
    pose, focal = stage.camera_pose(state)
    middle = (description.camera.width - 1) / 2.0, (description.camera.height - 1) / 2.0

    def under(u: float, v: float) -> Hit | None:
        ray = np.array([u - middle[0], v - middle[1], focal])
        return stage.look(np.asarray(pose.translation), pose.rotation.apply(ray / np.linalg.norm(ray)))

    return under


def is_within_outline(lens: Callable[[float, float], Hit | None], u: float, v: float, body: str) -> bool:
    """Tell whether what is a few pixels around (u, v) belongs to the same thing: nobody taps an outline."""
    around = [lens(u + dx, v + dy) for dx, dy in _AROUND]
    return all(hit is not None and hit.body == body for hit in around)


def _truths(
    stage: Stage, states: list[NDArray[np.float64]], hits: list[Hit], description: RobotDescription
) -> tuple[Tapped, ...]:
    points, normals = np.stack([hit.point for hit in hits]), np.stack([hit.normal for hit in hits])
    seen = [_seen(stage, state, points, normals, description) for state in states]
    where = np.stack([pixels for pixels, _, _ in seen], axis=1)
    is_visible = np.stack([visible for _, visible, _ in seen], axis=1)
    depth = np.stack([depths for _, _, depths in seen], axis=1)
    return tuple(
        Tapped(Pixel(*map(float, where[i, 0])), where[i], is_visible[i], depth[i])
        for i in range(len(hits))
        if is_visible[i, 0]
    )


def _seen(
    stage: Stage,
    state: NDArray[np.float64],
    points: FloatArray,
    normals: FloatArray,
    description: RobotDescription,
) -> tuple[FloatArray, NDArray[np.bool_], FloatArray]:
    pose, focal = stage.camera_pose(state)
    stage.place(state)
    origin = np.asarray(pose.translation)
    in_camera = pose.inv().apply(points)
    depth = in_camera[:, 2]
    size = np.array([description.camera.width, description.camera.height])
    pixels = focal * in_camera[:, :2] / np.where(depth > 0.01, depth, np.inf)[:, None] + (size - 1) / 2.0
    is_inside = np.all((pixels > _MARGIN) & (pixels < size - 1 - _MARGIN), axis=1) & (depth > 0.01)
    towards = origin - points
    faces = (normals * towards).sum(axis=1) > _SLANTED * np.linalg.norm(towards, axis=1)
    clear = np.array([stage.sees(origin, point) for point in points])
    return pixels, is_inside & faces & clear, depth


def _approach(stage: Stage, rng: np.random.Generator) -> tuple[PlanarPose, str] | None:
    """Return a start 2.5 m before some object from which the way to it is free, and the object's name."""
    stage.place(stage.at(PlanarPose()))
    for _ in range(_TRIES):
        name = str(rng.choice(list(stage.objects)))
        heading = float(rng.uniform(-math.pi, math.pi))
        ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
        start = stage.centre(name) - (_FROM + _LEVER) * ahead
        if stage.is_in_room(start) and _is_way_free(stage, start, ahead, name):
            aim = heading + float(rng.normal(0.0, 0.03))
            return PlanarPose(float(start[0]), float(start[1]), aim), name
    return None


def _is_way_free(stage: Stage, start: FloatArray, ahead: FloatArray, name: str) -> bool:
    """Tell whether nothing but the object stands in a strip as broad and high as the robot."""
    left = np.array([-ahead[1], ahead[0], 0.0])
    for aside in (-0.12, 0.0, 0.12):
        for up in (0.05, 0.15):
            origin = np.array([start[0], start[1], up]) + aside * left
            hit = stage.look(origin, ahead)
            if hit is not None and hit.body != name and float(np.linalg.norm(hit.point - origin)) < _FROM:
                return False
    return True
