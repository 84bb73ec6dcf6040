"""A tap to be: the scene, the robot with its faults, where it stands and which pixel is tapped."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.bench.fault_level import FaultLevel
from tapreach.bench.places import FARTHEST, NEAREST, SETTLED_S, Sought, pixel_of, places, surface_at
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import SurfacePoint, ask_truth
from tapreach.errors import SetupError
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, ManualClock
from tapreach.robot.config import RobotDescription


@dataclass(frozen=True)
class Stage:
    """scene, faults, seed of everything else random, the robot's place, the pixel, and the distance [m] from
    the camera to what lies there. thing: its name, '' for what hangs on a wall.
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

    @property
    def what(self) -> str:
        """What is tapped and where, for people."""
        return f"{self.scene_name}: {self.thing or 'the wall'}, {self.distance:.2f} m"


@dataclass(frozen=True)
class Setting:
    """What a stage is drawn in: a scene by its name, how wrong the robot is, and pictures a second."""

    number: int
    scene_name: str
    scene: Scene
    level: FaultLevel
    rate_hz: float


async def draw_in(
    setting: Setting,
    sought: Sequence[Sought],
    rng: np.random.Generator,
    is_fit: Callable[[Sought, PlanarPose, SurfacePoint], bool] = lambda *_: True,
) -> Stage:
    """Return a stage for one of the things sought. Raises SetupError when none of them can be tapped."""
    faults = setting.level.draw(setting.scene.faults, rng)
    seed = int(rng.integers(1 << 31))
    description = setting.level.robot_file(setting.rate_hz)
    clock = ManualClock()
    robot = InlineSimRobot(description, setting.scene, clock, faults, seed, has_pictures=False)
    await robot.connect()
    try:
        for thing, start in places(sought, setting.scene, description, rng) if sought else ():
            robot.place_base(start)
            await clock.advance(round(SETTLED_S * SECOND))
            pixel = pixel_of(thing, await ask_truth(robot), robot, rng)
            surface = None if pixel is None else surface_at(robot, pixel)
            if pixel is None or surface is None or not NEAREST <= surface.distance <= FARTHEST:
                continue
            if is_fit(thing, start, surface):
                return Stage(
                    setting.number, description, setting.scene_name, setting.scene, faults, seed, start,
                    pixel, thing.name, surface.distance,
                )  # fmt: skip
    finally:
        await robot.close()
    raise SetupError(
        f"no place in scene {setting.scene_name!r} from which a thing can be tapped (number {setting.number})"
    )
