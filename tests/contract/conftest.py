"""Every driver, ready for the same tests. A new driver adds one line to RIGS."""

import asyncio
import os
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from tests.drivers.arduino.memory import clocked_robot
from tests.firmware.sim.needs import needs_bed
from tests.firmware.sim.whole_robot import WholeRobot, described

from tapreach.drivers.fake import FakeRobot
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.options import resolve_scene
from tapreach.drivers.sim.robot import SimRobot
from tapreach.drivers.sim.scene import load_scene
from tapreach.errors import SetupError
from tapreach.robot.clock import MS, SECOND, Clock, ManualClock, MonotonicClock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.interface import Robot
from tapreach.robot.messages import STILL, ArmState, Frame, Health, Odometry, Twist

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 30.0


@dataclass
class Heard:
    """Everything that a robot has told."""

    odometry: list[Odometry] = field(default_factory=list)
    arm: list[ArmState] = field(default_factory=list)
    frames: list[Frame] = field(default_factory=list)
    health: list[Health] = field(default_factory=list)


@dataclass
class Rig:
    """A robot that is not yet connected, its clock, and what it has told."""

    robot: Robot
    clock: Clock
    heard: Heard = field(default_factory=Heard)

    def listen(self) -> None:
        self.robot.base.subscribe(self.heard.odometry.append)
        self.robot.arm.subscribe(self.heard.arm.append)
        self.robot.frames.subscribe(self.heard.frames.append)
        self.robot.subscribe_health(self.heard.health.append)

    async def pass_time(self, duration_ns: int, twist: Twist | None = None) -> None:
        """Let the robot live for a while; with a twist, send it every 20 ms as the control loop does."""
        end_ns = self.clock.now_ns() + duration_ns
        while self.clock.now_ns() < end_ns:
            if twist is not None:
                self.robot.base.drive(twist)
            step_ns = min(20 * MS, end_ns - self.clock.now_ns())
            if isinstance(self.clock, ManualClock):
                await self.clock.advance(step_ns)
            else:
                await self.clock.sleep_until(self.clock.now_ns() + step_ns)

    async def until(self, holds: Callable[[], Any], twist: Twist | None = None) -> None:
        """Let time pass until `holds`, in bounds; a robot in another process may lag behind the clock."""
        end_ns = self.clock.now_ns() + round(PATIENCE_S * SECOND)
        while not holds():
            assert self.clock.now_ns() < end_ns, "waited in vain"
            await self.pass_time(20 * MS, twist)

    async def rest(self) -> None:
        """Send zero until the base has come to rest."""
        await self.until(lambda: self.heard.odometry[-1].twist.is_zero, STILL)


def fake_rig() -> Rig:
    clock = ManualClock()
    description = load_robot(ROOT / "robots" / "fake.toml")
    return Rig(FakeRobot(description, clock, draws_in_thread=False), clock)


SMALL = {"width": 160, "height": 120, "fx": 533.0 / 4, "rate_hz": 10.0}


def sim_description() -> RobotDescription:
    """The simulated rover with a small picture and a bare room, so that starting and drawing cost little."""
    description = load_robot(ROOT / "robots" / "sim.toml")
    camera = description.camera.model_copy(update=SMALL)
    return description.model_copy(update={"camera": camera, "simulation": {"scene": "plain_floor"}})


def sim_inline_rig() -> Rig:
    clock, description = ManualClock(), sim_description()
    scene, faults = resolve_scene(description)
    return Rig(InlineSimRobot(description, scene, clock, faults), clock)


def sim_rig() -> Rig:
    clock, description = MonotonicClock(), sim_description()
    scene, faults = resolve_scene(description)
    return Rig(SimRobot(description, scene, clock, faults), clock)


def arduino_rig() -> Rig:
    robot = clocked_robot()
    return Rig(robot, robot.clock)


def firmware_rig() -> Rig:
    clock, scene = ManualClock(), load_scene("plain_floor")
    return Rig(WholeRobot(described(**SMALL), scene, clock), clock)


RIGS = {
    "fake": fake_rig,
    "sim inline": sim_inline_rig,
    "sim process": sim_rig,
    "arduino": arduino_rig,
    "firmware": firmware_rig,
}
NEEDS = {"firmware": needs_bed}
Scenario = Callable[[Rig], Awaitable[None]]


@pytest.fixture(params=[pytest.param(name, marks=NEEDS.get(name, ())) for name in RIGS])
def make_rig(request: pytest.FixtureRequest) -> Callable[[], Rig]:
    """Return what makes a rig of each driver in turn."""
    return RIGS[request.param]


@pytest.fixture
def play(make_rig: Callable[[], Rig]) -> Callable[[Scenario], None]:
    """Return a function that runs a scenario with a connected robot."""

    async def run(scenario: Scenario) -> None:
        rig = make_rig()
        rig.listen()
        try:
            await rig.robot.connect()
        except SetupError as error:
            if os.environ.get("CI"):
                raise  # the gate installs what draws: without it the simulator would go untested
            pytest.skip(f"nothing can draw here: {error}")
        try:
            await rig.until(lambda: rig.heard.odometry and rig.heard.arm)
            await scenario(rig)
        finally:
            await rig.robot.close()

    return lambda scenario: asyncio.run(run(scenario))
