"""Where the robot stands and what is tapped: see `places`; any thing of the scene, any place on it."""

from dataclasses import dataclass

from tapreach.bench.fault_level import LOCATING
from tapreach.bench.locate_plan import generator, scene_of
from tapreach.bench.places import FARTHEST, NEAREST, SETTLED_S, Sought, pixel_on, places, surface_at
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import ask_truth
from tapreach.errors import SetupError
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, ManualClock
from tapreach.robot.config import RobotDescription


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
    faults = LOCATING.draw(scene.faults, rng)
    own_seed = int(rng.integers(1 << 31))
    description = LOCATING.robot_file(rate_hz)
    clock = ManualClock()
    robot = InlineSimRobot(description, scene, clock, faults, own_seed, has_pictures=False)
    await robot.connect()
    try:
        for thing, start in places(_all(scene), scene, description, rng):
            robot.place_base(start)
            await clock.advance(round(SETTLED_S * SECOND))
            truth = await ask_truth(robot)
            pixel = pixel_on(truth.object(thing.name), truth.camera_pose, robot, rng)
            surface = None if pixel is None else surface_at(robot, pixel)
            if pixel is None or surface is None or not NEAREST <= surface.distance <= FARTHEST:
                continue
            return Stage(
                number, description, name, scene, faults, own_seed, start, pixel, thing.name, surface.distance
            )
    finally:
        await robot.close()
    raise SetupError(f"no place in scene {name!r} from which a thing can be tapped (tap {number})")


def _all(scene: Scene) -> list[Sought]:
    named = zip(scene.object_names(), scene.objects, strict=True)
    return [Sought(name, thing.position) for name, thing in named]
