"""The simulated robot without a process, stepped by the clock it is given: fast in tests."""

import asyncio
from collections import deque

import numpy as np
from numpy.typing import NDArray

from tapreach.drivers.sim.camera import HISTORY, SimCamera, Snapshot, state_at
from tapreach.drivers.sim.child_physics import TRUTH_HISTORY, telemetry_of
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.host_parts import HostArm, HostBase, HostCamera
from tapreach.drivers.sim.protocol import Drive, Message, MoveArm
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import SurfacePoint, TruthTeller
from tapreach.drivers.sim.world import World
from tapreach.errors import LinkLost
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.config import RobotDescription
from tapreach.robot.driver_robot import DriverRobot
from tapreach.robot.messages import ArmPose, Health, LinkStatus, Twist

TELEMETRY_EVERY = 2


class InlineSimRobot(DriverRobot):
    """A Robot whose world is stepped by a task of the event loop, one control period per 10 ms of `clock`."""

    def __init__(
        self,
        description: RobotDescription,
        scene: Scene,
        clock: Clock,
        faults: SimFaults | None = None,
        seed: int = 0,
        has_pictures: bool = True,
        opengl: str = "auto",
        shadows: bool = True,
    ) -> None:
        super().__init__(description, "the simulated robot has not been started")
        self._scene, self._clock = scene, clock
        self._faults = faults if faults is not None else scene.faults
        self._seed, self._has_pictures, self._opengl, self._shadows = seed, has_pictures, opengl, shadows
        self.base = HostBase(description.base, self._send)
        self.arm = HostArm(description.arm, self._send)
        self.frames = HostCamera(description.camera, clock)
        self._history: deque[Snapshot] = deque(maxlen=TRUTH_HISTORY)
        self._world: World | None = None
        self._renderer: Renderer | None = None
        self._camera: SimCamera | None = None
        self._teller: TruthTeller | None = None
        self._task: asyncio.Task[None] | None = None

    async def connect(self) -> None:
        """Build the world and begin to step it. Raises SetupError when nothing can draw."""
        world = World(self._scene, self.description, self._faults, self._seed)
        if self._has_pictures:
            picture = self.description.camera
            self._renderer = Renderer(world.model, picture.width, picture.height, self._opengl)
            self._renderer.shadows = self._shadows
            self._camera = SimCamera(self._renderer, self._faults, self._seed, picture.delay_ms)
        self._world = world
        self._teller = TruthTeller(world.model, self._scene)
        self._history.append(Snapshot(self._clock.now_ns(), world.snapshot()))
        self._set_health(Health(LinkStatus.RUNNING))
        self._task = asyncio.get_running_loop().create_task(self._step_along(world))

    async def close(self) -> None:
        """Stop stepping and free the renderer."""
        if self._task:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
            self._task = None
        if self._renderer:
            self._renderer.close()
            self._renderer = self._camera = None
        self._world = None
        if self._health.is_running:
            self._set_health(Health(LinkStatus.LOST, "the simulated robot was switched off"))

    async def ask_truth_json(self, at_ns: int) -> str:
        """Return the truth as JSON; call truth.ask_truth instead, from tests and benches only."""
        if self._teller is None:
            raise LinkLost(self._health.reason)
        history = list(self._history)
        when_ns = at_ns or history[-1].captured_ns
        return self._teller.tell(state_at(history, when_ns), when_ns).to_json()

    def surfaces_seen(
        self, directions_in_camera: NDArray[np.float64], at_ns: int = 0
    ) -> list[SurfacePoint | None]:
        """Return what truly lies in each direction (n, 3) out of the camera; for tests and benches only."""
        if self._teller is None:
            raise LinkLost(self._health.reason)
        history = list(self._history)
        qpos = state_at(history, at_ns or history[-1].captured_ns)
        return self._teller.surfaces(qpos, directions_in_camera)

    def place_base(self, pose: PlanarPose) -> None:
        """Lift the robot to `pose` in the scene; the odometry does not notice. Raises LinkLost."""
        if self._world is None:
            raise LinkLost(self._health.reason)
        self._world.place_base(pose)
        self._history.append(Snapshot(self._clock.now_ns(), self._world.snapshot()))

    def _send(self, message: Message) -> None:
        if self._world is None:
            raise LinkLost(self._health.reason)
        if isinstance(message, Drive):
            self._world.drive(Twist(message.linear, message.angular))
        elif isinstance(message, MoveArm):
            target = ArmPose(message.rotation, message.shoulder, message.elbow, message.claw)
            self._world.move_arm(target)

    async def _step_along(self, world: World) -> None:
        captured_ns = self._clock.now_ns()
        picture_ns = round(SECOND / self.description.camera.rate_hz)
        next_picture_ns = captured_ns + picture_ns
        for count in range(1, 1 << 62):
            captured_ns += round(world.period_s * SECOND)
            await self._clock.sleep_until(captured_ns)
            world.step()
            self._history.append(Snapshot(captured_ns, world.snapshot()))
            if world.warnings:
                self._set_health(Health(LinkStatus.LOST, "; ".join(world.warnings)))
                return
            if count % TELEMETRY_EVERY == 0:
                telemetry = telemetry_of(world, captured_ns)
                self.base.take(telemetry)
                self.arm.take(telemetry)
            if self._camera and captured_ns >= next_picture_ns:
                next_picture_ns += picture_ns
                self._camera.take(list(self._history)[-HISTORY:])
            self._deliver(captured_ns)

    def _deliver(self, now_ns: int) -> None:
        if self._camera:
            for picture in self._camera.delivered(now_ns):
                self.frames.take(picture.captured_ns + self._camera.unknown_delay_ns, picture.jpeg)
