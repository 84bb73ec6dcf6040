"""Shared by the tests of the simulated robot: a robot file, small scenes, and driving without a clock."""

from collections.abc import Mapping
from typing import Any

from scipy.spatial.transform import RigidTransform

from tapreach.drivers.sim.child_physics import telemetry_of
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.scene import Room, Scene
from tapreach.drivers.sim.truth import TruthTeller, WorldTruth
from tapreach.drivers.sim.world import World
from tapreach.drivers.tick_odometry import TickOdometry
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.resources import resource_path
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.messages import Twist

ROBOT: RobotDescription = load_robot(resource_path("robots") / "sim.toml")
HALL = Scene(title="Empty hall", room=Room(x=(-5.0, 5.0), y=(-5.0, 5.0), skirting=False))


class Rig:
    """A world, its odometry and its truth, driven period by period."""

    def __init__(self, scene: Scene = HALL, faults: Mapping[str, Any] | None = None, seed: int = 0) -> None:
        self.world = World(scene, ROBOT, scene.faults.merged(faults or {}), seed)
        self.odometry = TickOdometry(ROBOT.base)
        self._teller = TruthTeller(self.world.model, scene)
        self.now_ns = 1_000_000_000
        self._read()

    def drive(self, linear: float, angular: float, duration_s: float) -> None:
        """Send the twist every 10 ms for `duration_s`."""
        for _ in range(round(duration_s / self.world.period_s)):
            self.world.drive(Twist(linear, angular))
            self.step()

    def step(self, periods: int = 1) -> None:
        """Let time pass without a word from the host."""
        for _ in range(periods):
            self.world.step()
            self.now_ns += 10_000_000
            self._read()

    def _read(self) -> None:
        told = telemetry_of(self.world, self.now_ns)
        self.reading = self.odometry.update(told.captured_ns, told.left_ticks, told.right_ticks)

    @property
    def truth(self) -> WorldTruth:
        return self._teller.tell(self.world.snapshot(), self.now_ns)

    @property
    def pose(self) -> PlanarPose:
        """Where the base truly is."""
        return self.truth.base_pose

    def wheel_speeds(self) -> tuple[float, float]:
        """True speeds of the wheels [rad/s]."""
        data = self.world.data
        return float(data.joint("wheel_left").qvel[0]), float(data.joint("wheel_right").qvel[0])


def faults(**values: Any) -> SimFaults:
    return SimFaults().merged(values)


def camera_in_world(truth: WorldTruth) -> RigidTransform:
    """Where the camera should be by the robot file, on the true base."""
    base = RigidTransform.from_matrix(truth.world_from_base)
    return base * ROBOT.camera.mount.base_from_camera()
