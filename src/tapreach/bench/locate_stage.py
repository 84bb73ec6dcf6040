"""Where the robot stands and what is tapped: a random thing, distance and side, and a random place on it.

A thing of the scene is drawn, a distance of 0.5 to 3 m, the side it is seen from and where across the picture
it stands; the robot must fit there, with 0.35 m of free floor ahead of it, and when turned by 25 degrees to
either side, since locating knows of no obstacles. Then pixels are drawn evenly from the box around the thing
in the picture until one lies on the thing with its 8 neighbours 4 px away. What is hidden, or too small for
that, is drawn anew (the distance only after 40 tries, so that far ones are as frequent as near ones where the
room allows it). Nothing else is asked of the place.
"""

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import RigidTransform

from tapreach.bench.locate_faults import draw_faults, robot_file
from tapreach.bench.locate_plan import generator, scene_of
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.scene_checks import Solid, solid_of_object, solid_of_part
from tapreach.drivers.sim.truth import ObjectTruth, SurfacePoint, ask_truth
from tapreach.errors import SetupError
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, ManualClock
from tapreach.robot.config import MountSection, RobotDescription

NEAREST, FARTHEST = 0.5, 3.0
"""[m] from the camera to the tapped surface."""
INSIDE_PX = 4.0
SETTLED_S = 0.4
_DISTANCES, _PLACES, _PIXELS = 20, 40, 30
_AHEAD = 0.35
_SIDES = (math.radians(-25.0), 0.0, math.radians(25.0))
_ROBOT = np.array([[-0.18, -0.13], [0.22 + _AHEAD, -0.13], [0.22 + _AHEAD, 0.13], [-0.18, 0.13]])
_AROUND = INSIDE_PX * np.array([(du, dv) for du in (-1, 0, 1) for dv in (-1, 0, 1)])
_HALF_VIEW_DEG = 26.0
_FLAT = 0.03
"""What is no higher [m] is driven over, not into."""


@dataclass(frozen=True)
class Stage:
    """A tap to be: scene, faults, seed of everything else random, the robot's place, the pixel, and the
    distance [m] from the camera to what lies there.
    """

    number: int
    description: RobotDescription
    scene_name: str
    scene: Scene
    faults: SimFaults
    seed: int
    start: PlanarPose
    pixel: Pixel
    thing: str
    distance: float


async def draw_stage(seed: int, number: int, rate_hz: float) -> Stage:
    """Return the tap with this number. Raises SetupError when the scene shows nothing that can be tapped."""
    rng = generator(seed, number)
    name, scene = scene_of(seed, number)
    faults = draw_faults(scene.faults, rng)
    own_seed = int(rng.integers(1 << 31))
    description = robot_file(rate_hz)
    clock = ManualClock()
    robot = InlineSimRobot(description, scene, clock, faults, own_seed, has_pictures=False)
    await robot.connect()
    try:
        for thing, start in _places(scene, description, rng):
            robot.place_base(start)
            await clock.advance(round(SETTLED_S * SECOND))
            truth = await ask_truth(robot)
            pixel = _pixel_on(truth.object(thing), truth.camera_pose, robot, rng)
            if pixel is not None:
                surface = surface_at(robot, pixel)
                if surface is not None and NEAREST <= surface.distance <= FARTHEST:
                    return Stage(
                        number,
                        description,
                        name,
                        scene,
                        faults,
                        own_seed,
                        start,
                        pixel,
                        thing,
                        surface.distance,
                    )
    finally:
        await robot.close()
    raise SetupError(f"no place in scene {name!r} from which a thing can be tapped (tap {number})")


def surface_at(robot: InlineSimRobot, pixel: Pixel, at_ns: int = 0) -> SurfacePoint | None:
    """Return what truly lies under a pixel."""
    directions = robot.description.camera.model().unproject([pixel.to_array()])
    return robot.surfaces_seen(directions, at_ns)[0]


def _places(
    scene: Scene, description: RobotDescription, rng: np.random.Generator
) -> Iterable[tuple[str, PlanarPose]]:
    """Draw things and places that see them, the robot clear of everything; may come to an end."""
    solids = [solid_of_object(thing) for thing in scene.objects]
    parts = [(piece, part) for piece in scene.furniture for part in piece.parts() if part.is_solid]
    solids += [solid_of_part(piece, part) for piece, part in parts]
    low = [solid for solid in solids if solid.height[1] > _FLAT]
    names = scene.object_names()
    for distance in rng.uniform(NEAREST, FARTHEST, _DISTANCES):
        for _ in range(_PLACES):
            index = int(rng.integers(len(names)))
            start = _facing(scene.objects[index].position, float(distance), description.camera.mount, rng)
            if _is_clear(start, scene, low):
                yield names[index], start


def _facing(
    position: tuple[float, float], distance: float, mount: MountSection, rng: np.random.Generator
) -> PlanarPose:
    side = rng.uniform(-math.pi, math.pi)
    across = math.radians(rng.uniform(-_HALF_VIEW_DEG, _HALF_VIEW_DEG))
    heading = side - across
    x = position[0] - distance * math.cos(side) - mount.forward * math.cos(heading)
    y = position[1] - distance * math.sin(side) - mount.forward * math.sin(heading)
    return PlanarPose(float(x), float(y), heading)


def _is_clear(start: PlanarPose, scene: Scene, solids: list[Solid]) -> bool:
    turned = (replace(start, heading=start.heading + side) for side in _SIDES)
    return all(_fits(pose, scene, solids) for pose in turned)


def _fits(start: PlanarPose, scene: Scene, solids: list[Solid]) -> bool:
    c, s = math.cos(start.heading), math.sin(start.heading)
    outline = _ROBOT @ np.array([[c, s], [-s, c]]) + (start.x, start.y)
    low, high = np.transpose([scene.room.x, scene.room.y])
    if np.any(outline < low) or np.any(outline > high):
        return False
    return not any(solid.overlaps(Solid(outline, (0.0, 0.4))) for solid in solids)


def _pixel_on(
    thing: ObjectTruth, camera_pose: RigidTransform, robot: InlineSimRobot, rng: np.random.Generator
) -> Pixel | None:
    """Draw a pixel that lies on the thing with all that is 4 px around it; None when none is found."""
    camera = robot.description.camera.model()
    corners = 0.5 * np.array(thing.size) * np.array(list(itertools.product((-1, 1), repeat=3)))
    in_world = RigidTransform.from_matrix(np.array(thing.world_from_object)).apply(corners)
    in_camera = camera_pose.inv().apply(in_world)
    if np.any(in_camera[:, 2] < 0.1):
        return None
    seen = camera.project(in_camera).pixels
    margin = INSIDE_PX + 1.0
    low = np.maximum(seen.min(axis=0), margin)
    high = np.minimum(seen.max(axis=0), (camera.size.width - 1 - margin, camera.size.height - 1 - margin))
    if np.any(low >= high):
        return None
    for u, v in rng.uniform(low, high, (_PIXELS, 2)):
        met = robot.surfaces_seen(camera.unproject(_AROUND + np.array([u, v])))
        if all(surface is not None and surface.name == thing.name for surface in met):
            return Pixel(float(u), float(v))
    return None
