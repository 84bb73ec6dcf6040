"""Where the robot stands and what is tapped, drawn at random: a distance, a thing, the side it is seen from,
where across the picture it stands, and a place on it.

The robot must fit there, with 0.35 m of free floor ahead of it, and when turned by 25 degrees to either side.
Pixels are drawn evenly from the box around the thing in the picture until one lies on it with its 8
neighbours 4 px away.
"""

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.scene_checks import Solid, solid_of_object, solid_of_part
from tapreach.drivers.sim.truth import SurfacePoint, WorldTruth
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import MountSection, RobotDescription

NEAREST, FARTHEST = 0.5, 3.0
"""[m] from the camera to the tapped surface."""
SETTLED_S = 0.4
"""How long the robot stands before it is tapped [s]."""
FLAT = 0.03
"""What is no higher [m] is driven over, not into."""
_INSIDE_PX = 4.0
_DISTANCES, _PLACES, _PIXELS = 20, 40, 30
_AHEAD = 0.35
_SIDES = (math.radians(-25.0), 0.0, math.radians(25.0))
_ROBOT = np.array([[-0.18, -0.13], [0.22 + _AHEAD, -0.13], [0.22 + _AHEAD, 0.13], [-0.18, 0.13]])
_AROUND = _INSIDE_PX * np.array([(du, dv) for du in (-1, 0, 1) for dv in (-1, 0, 1)])
_HALF_VIEW_DEG = 26.0


@dataclass(frozen=True)
class Sought:
    """What may be tapped: its name, and where it stands on the floor (x, y) [m].

    corners_in_world (n, 3) [m]: of a flat thing on a wall, which has no name; None for what stands.
    """

    name: str
    position: tuple[float, float]
    corners_in_world: FloatArray | None = None


def things_of(scene: Scene) -> list[Sought]:
    """Return all things of a scene that can be moved."""
    named = zip(scene.object_names(), scene.objects, strict=True)
    return [Sought(name, thing.position) for name, thing in named]


def places(
    sought: Sequence[Sought], scene: Scene, description: RobotDescription, rng: np.random.Generator
) -> Iterable[tuple[Sought, PlanarPose]]:
    """Draw things and places that face them, the robot clear of everything; may come to an end.

    The distance is drawn anew only after 40 tries, so that far ones are as frequent as near ones where the
    room allows it.
    """
    low = solids(scene)
    for distance in rng.uniform(NEAREST, FARTHEST, _DISTANCES):
        for _ in range(_PLACES):
            thing = sought[int(rng.integers(len(sought)))]
            start = _facing(thing.position, float(distance), description.camera.mount, rng)
            if _is_clear(start, scene, low):
                yield thing, start


def solids(scene: Scene) -> list[Solid]:
    """Return all that the robot can drive into."""
    found = [solid_of_object(thing) for thing in scene.objects]
    parts = [(piece, part) for piece in scene.furniture for part in piece.parts() if part.is_solid]
    found += [solid_of_part(piece, part) for piece, part in parts]
    return [solid for solid in found if solid.height[1] > FLAT]


def surface_at(robot: InlineSimRobot, pixel: Pixel, at_ns: int = 0) -> SurfacePoint | None:
    """Return what truly lies under a pixel."""
    directions = robot.description.camera.model().unproject([pixel.to_array()])
    return robot.surfaces_seen(directions, at_ns)[0]


def pixel_of(
    sought: Sought, truth: WorldTruth, robot: InlineSimRobot, rng: np.random.Generator
) -> Pixel | None:
    """Draw a pixel that lies on the thing with all that is 4 px around it; None when none is found."""
    corners = sought.corners_in_world
    if corners is None:
        thing = truth.object(sought.name)
        corners = 0.5 * np.array(thing.size) * np.array(list(itertools.product((-1, 1), repeat=3)))
        corners = RigidTransform.from_matrix(np.array(thing.world_from_object)).apply(corners)
    camera = robot.description.camera.model()
    in_camera = truth.camera_pose.inv().apply(corners)
    if np.any(in_camera[:, 2] < 0.1):
        return None
    seen = camera.project(in_camera).pixels
    margin = _INSIDE_PX + 1.0
    low = np.maximum(seen.min(axis=0), margin)
    high = np.minimum(seen.max(axis=0), (camera.size.width - 1 - margin, camera.size.height - 1 - margin))
    if np.any(low >= high):
        return None
    for u, v in rng.uniform(low, high, (_PIXELS, 2)):
        met = robot.surfaces_seen(camera.unproject(_AROUND + np.array([u, v])))
        if all(surface is not None and surface.name == sought.name for surface in met):
            return Pixel(float(u), float(v))
    return None


def _facing(
    position: tuple[float, float], distance: float, mount: MountSection, rng: np.random.Generator
) -> PlanarPose:
    side = rng.uniform(-math.pi, math.pi)
    across = math.radians(rng.uniform(-_HALF_VIEW_DEG, _HALF_VIEW_DEG))
    heading = side - across
    x = position[0] - distance * math.cos(side) - mount.forward * math.cos(heading)
    y = position[1] - distance * math.sin(side) - mount.forward * math.sin(heading)
    return PlanarPose(float(x), float(y), heading)


def _is_clear(start: PlanarPose, scene: Scene, things: list[Solid]) -> bool:
    turned = (replace(start, heading=start.heading + side) for side in _SIDES)
    return all(_fits(pose, scene, things) for pose in turned)


def _fits(start: PlanarPose, scene: Scene, things: list[Solid]) -> bool:
    c, s = math.cos(start.heading), math.sin(start.heading)
    outline = _ROBOT @ np.array([[c, s], [-s, c]]) + (start.x, start.y)
    low, high = np.transpose([scene.room.x, scene.room.y])
    if np.any(outline < low) or np.any(outline > high):
        return False
    return not any(thing.overlaps(Solid(outline, (0.0, 0.4))) for thing in things)
