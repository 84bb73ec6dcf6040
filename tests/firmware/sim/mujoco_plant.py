"""The rover of the simulator behind the firmware's motor driver: MuJoCo's wheels, floor and slip."""

import math

import mujoco

from tapreach.drivers.sim.scene import Room, Scene
from tapreach.drivers.sim.world import JOINTS, World
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot

SUPPLY_VOLTS = 6.0
SIDES = ("left", "right")


class MujocoPlant:
    """See Plant. The world is stepped by volts at its motors; its own simulated board is left out."""

    def __init__(self, scene: Scene, description: RobotDescription) -> None:
        self.world = World(scene, description, scene.faults)
        self._motors = [self.world.model.actuator(f"motor_{side}").id for side in SIDES]
        self._wheels = [self.world.model.joint(f"wheel_{side}").qposadr[0] for side in SIDES]
        self._servos = [self.world.model.actuator(f"servo_{name}").id for name in JOINTS]
        self._start = [float(self.world.data.qpos[address]) for address in self._wheels]
        self._turns = 0.0
        self._heading = self._heading_now()

    def step(self, duties: tuple[float, float], seconds: float) -> None:
        """See Plant."""
        # One step of the physics for one of the bed, two periods of the PWM: 2.4 % more than the tuned 2 ms.
        self.world.model.opt.timestep = seconds
        self.world.data.ctrl[self._motors] = [SUPPLY_VOLTS * duty for duty in duties]
        mujoco.mj_step(self.world.model, self.world.data)
        turned = self._heading_now() - self._heading
        self._heading += turned
        self._turns += math.remainder(turned, math.tau)

    def move_servos(self, angles: tuple[float, ...]) -> None:
        """Hand the servos their angles [rad], base to claw."""
        self.world.data.ctrl[self._servos] = angles

    def _heading_now(self) -> float:
        start = self.world.model.joint("base").qposadr[0]
        w, x, y, z = self.world.data.qpos[start + 3 : start + 7]
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    @property
    def angles(self) -> tuple[float, float]:
        """See Plant."""
        left, right = (
            float(self.world.data.qpos[a]) - b for a, b in zip(self._wheels, self._start, strict=True)
        )
        return left, right

    @property
    def pose(self) -> tuple[float, float, float]:
        """See Plant."""
        start = self.world.model.joint("base").qposadr[0]
        x, y = self.world.data.qpos[start : start + 2]
        return float(x), float(y), self._turns


def rover_in_hall() -> MujocoPlant:
    """Return the simulator's rover in an empty hall."""
    hall = Scene(title="Empty hall", room=Room(x=(-9.0, 9.0), y=(-9.0, 9.0), skirting=False))
    return MujocoPlant(hall, load_robot(resource_path("robots") / "sim.toml"))
