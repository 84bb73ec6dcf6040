"""The product's driver, the compiled firmware in its microcontroller, MuJoCo's rover and its camera: a Robot.

All of it goes by a clock that is turned by hand; bytes pass without a line, up to 5 ms late.
"""

import asyncio
from collections import deque

import numpy as np
from numpy.typing import NDArray
from tests.firmware.sim.mujoco_plant import MujocoPlant
from tests.firmware.sim.servo_horns import ServoHorns
from tests.firmware.sim.started import started_rover

from tapreach.drivers.arduino.parts import NoCamera, NoCameraStatus
from tapreach.drivers.arduino.robot import ArduinoRobot
from tapreach.drivers.sim.camera import HISTORY, SimCamera, Snapshot, state_at
from tapreach.drivers.sim.child_physics import TRUTH_HISTORY
from tapreach.drivers.sim.host_parts import HostCamera
from tapreach.drivers.sim.renderer import Renderer
from tapreach.drivers.sim.scene import Scene
from tapreach.drivers.sim.truth import SurfacePoint, TruthTeller
from tapreach.resources import resource_path
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.config import RobotDescription, load_robot

STEP_NS = 5 * MS
OPENING_S = 0.0005
"""Real time for the threads that open and close a port."""


def described(**camera: float) -> RobotDescription:
    """The simulator's rover on a board and servos; `camera` says what differs of it."""
    rover = load_robot(resource_path("robots") / "sim.toml")
    with_board = load_robot(resource_path("robots") / "rover-pi.toml")
    servos = with_board.arm.servos
    reach = {
        "shoulder": servos.shoulder.model_copy(update={"high_us": 2300}),
        "elbow": servos.elbow.model_copy(update={"pulse_at_zero_us": 1500.0, "high_us": 2100}),
    }
    arm = rover.arm.model_copy(update={"servos": servos.model_copy(update=reach)})
    seen = rover.camera.model_copy(update=camera)
    parts = {"driver": "arduino", "link": with_board.link, "arm": arm, "camera": seen}
    return rover.model_copy(update=parts)


class Eye(HostCamera):
    """See RobotCamera; pictures are handed to `take`."""

    status = NoCameraStatus()
    subscribe_status = NoCamera.subscribe_status
    start = NoCamera.start
    close = NoCamera.close


class Port:
    """The driver's end of the line."""

    def __init__(self, robot: "WholeRobot", hear) -> None:
        self._robot, self.hear = robot, hear

    def write(self, data: bytes) -> None:
        self._robot.rover.avr.send(data)

    def close(self) -> None:
        self._robot.port = None


class WholeRobot(ArduinoRobot):
    """See Robot. `rover` is the board with what is joined to its pins."""

    def __init__(
        self,
        description: RobotDescription,
        scene: Scene,
        clock: ManualClock,
        board: str = "uno",
    ) -> None:
        super().__init__(description, clock, lambda told, clock: Eye(told.camera, clock), self._open)
        self.scene, self.clock = scene, clock
        self.plant = MujocoPlant(scene, description)
        self.rover = started_rover(board, self.plant)
        self.port: Port | None = None
        self._horns = ServoHorns(self.rover, self.plant, description.arm)
        self._history: deque[Snapshot] = deque(maxlen=TRUTH_HISTORY)
        self._teller = TruthTeller(self.plant.world.model, scene)
        self._renderer: Renderer | None = None
        self._eyes: SimCamera | None = None
        self._steps: asyncio.Task[None] | None = None

    def _open(self, section, hear, end) -> Port:
        self.port = Port(self, hear)
        return self.port

    async def connect(self) -> None:
        """Turn the clock until it is connected. Raises SetupError when nothing can draw."""
        size = self.description.camera
        self._renderer = Renderer(self.plant.world.model, size.width, size.height)
        self._eyes = SimCamera(self._renderer, self.scene.faults, 0, size.delay_ms)
        self._steps = asyncio.create_task(self._step_along())
        await self._while_time_passes(super().connect())

    async def close(self) -> None:
        """See Robot."""
        await self._while_time_passes(super().close())
        if self._steps is not None:
            self._steps.cancel()
            await asyncio.gather(self._steps, return_exceptions=True)
            self._steps = None
        self.rover.close()
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None

    async def _while_time_passes(self, work) -> None:
        task = asyncio.ensure_future(work)
        while not task.done():
            await self.clock.advance(10 * MS)
            await asyncio.sleep(OPENING_S)
        await task

    async def _step_along(self) -> None:
        began_ns, began_us = self.clock.now_ns(), self.rover.now_us
        now_ns = next_picture_ns = began_ns
        while True:
            self.rover.run_to(began_us + (now_ns - began_ns) / 1000)
            self._horns.follow()
            self._history.append(Snapshot(now_ns, self.plant.world.snapshot()))
            heard = self.rover.avr.receive()
            if self.port is not None and heard:
                self.port.hear(heard)
            if now_ns >= next_picture_ns:
                next_picture_ns += round(SECOND / self.description.camera.rate_hz)
                self._look()
            now_ns += STEP_NS
            await self.clock.sleep_until(now_ns)
            self._show(now_ns)

    def _look(self) -> None:
        if self._eyes is not None:
            self._eyes.take(list(self._history)[-HISTORY:])

    def _show(self, now_ns: int) -> None:
        if self._eyes is not None:
            for picture in self._eyes.delivered(now_ns):
                self.frames.take(picture.captured_ns, picture.jpeg)

    async def ask_truth_json(self, at_ns: int) -> str:
        """Return the truth as JSON; call truth.ask_truth instead."""
        when_ns = at_ns or self._history[-1].captured_ns
        return self._teller.tell(self._state(when_ns), when_ns).to_json()

    def surfaces_seen(self, directions: NDArray[np.float64], at_ns: int) -> list[SurfacePoint | None]:
        """Return what truly lies in each direction (n, 3) out of the camera."""
        return self._teller.surfaces(self._state(at_ns), directions)

    def _state(self, at_ns: int) -> NDArray[np.float64]:
        return state_at(list(self._history), at_ns)
