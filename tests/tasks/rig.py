"""A whole robot in simulated time: world, camera, control loop, operator, frames, poses; what a task
needs.
"""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.drivers.sim.faults import SimFaults
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.scene import Scene
from tapreach.errors import LinkLost
from tapreach.estimation.pose_history import PoseHistory
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.config import RobotDescription, load_robot
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.interface import Robot
from tapreach.robot.messages import Frame, Odometry
from tapreach.tasks.compute import InlineCompute
from tapreach.tasks.fetch.fetch_state import FetchState
from tapreach.tasks.planned_move import PlannedMove
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.target import Target
from tapreach.tasks.task import TaskContext

ROOT = Path(__file__).resolve().parents[2]
OPERATOR = 1
CAMERA_SILENCE_NS = 2 * SECOND


def sim_description(rate_hz: float = 10.0) -> RobotDescription:
    """The simulated robot with a slower camera: drawing pictures is what takes the time."""
    description = load_robot(ROOT / "robots" / "sim.toml")
    camera = description.camera.model_copy(update={"rate_hz": rate_hz})
    return description.model_copy(update={"camera": camera})


def bare_context() -> TaskContext:
    """A context without a robot, for what never touches one."""
    clock = ManualClock()

    async def no_frame(frame_id: int) -> Frame:
        raise LinkLost("there is no camera")

    return TaskContext(
        description=sim_description(),
        robot=None,  # type: ignore[arg-type]
        pilot=None,  # type: ignore[arg-type]
        frames=FrameStore(),
        poses=PoseHistory(),
        compute=InlineCompute(),
        clock=clock,
        next_frame=no_frame,
        report=lambda report: None,
        show_target=lambda target: None,
    )


class Frames:
    """Stores what the camera sends and lets tasks wait for the next."""

    def __init__(self, robot: Robot, clock: ManualClock) -> None:
        self.store = FrameStore()
        self._clock = clock
        self._arrived = asyncio.Event()
        self.is_silent = False
        self.change: Callable[[Frame], Frame] = lambda frame: frame
        robot.frames.subscribe(self._take)

    def _take(self, frame: Frame) -> None:
        if not self.is_silent:
            self.store.add(self.change(frame))
            self._arrived.set()

    async def next_frame(self, frame_id: int) -> Frame:
        until_ns = self._clock.now_ns() + CAMERA_SILENCE_NS
        while (newest := self.store.newest) is None or newest.frame_id <= frame_id:
            if self._clock.now_ns() >= until_ns:
                raise LinkLost("no picture for 2 s")
            await self._clock.sleep_until(self._clock.now_ns() + 5 * MS)
        return newest


class Doing:
    """A task that does what it is given."""

    kind = "doing"

    def __init__(self, do: Callable[[TaskContext], Awaitable[object]]) -> None:
        self._do = do

    async def run(self, context: TaskContext) -> str:
        await self._do(context)
        return "done"


@dataclass
class Rig:
    """Everything, running; `advance` turns the time."""

    clock: ManualClock
    robot: Robot
    loop: ControlLoop
    runner: TaskRunner
    frames: Frames
    context: TaskContext
    targets: list[Target] = field(default_factory=list)
    moves: list[PlannedMove | None] = field(default_factory=list)
    progress: list[TaskProgress] = field(default_factory=list)
    fetches: list[FetchState | None] = field(default_factory=list)

    async def advance(self, seconds: float) -> None:
        await self.clock.advance(round(seconds * SECOND))

    async def finish(self, at_most: float = 60.0) -> TaskProgress:
        """Turn the time until the task has ended."""
        await self.until(lambda: not self.runner.is_running, at_most)
        assert self.runner.progress is not None
        return self.runner.progress

    async def until(self, condition: Callable[[], bool], at_most: float = 20.0) -> None:
        end_ns = self.clock.now_ns() + round(at_most * SECOND)
        while not condition():
            assert self.clock.now_ns() < end_ns, f"did not happen within {at_most} s"
            await self.clock.advance(10 * MS)


@asynccontextmanager
async def running_rig(make_robot: Callable[[ManualClock], Robot]) -> AsyncIterator[Rig]:
    """A rig around a robot, with an operator who holds the lease and never lets go."""
    clock = ManualClock()
    robot = make_robot(clock)
    poses, frames = PoseHistory(), Frames(robot, clock)
    robot.base.subscribe(lambda reading: _remember(poses, reading))
    deadman, lease = Deadman(clock), Lease(clock)
    authority = Authority(robot, clock, lease, deadman, EmergencyStop(clock, lambda: None))
    loop = ControlLoop(authority)
    context = TaskContext(
        description=robot.description,
        robot=robot,
        pilot=LoopPilot(loop, robot),
        frames=frames.store,
        poses=poses,
        compute=InlineCompute(),
        clock=clock,
        next_frame=frames.next_frame,
        report=lambda report: None,
        show_target=lambda target: rig.targets.append(target),
        show_move=lambda move: rig.moves.append(move),
        show_fetch=lambda state: rig.fetches.append(state),
    )
    runner = TaskRunner(context, loop, lambda progress: rig.progress.append(progress))
    rig = Rig(clock, robot, loop, runner, frames, context)
    await robot.connect()
    lease.request(OPERATOR)
    tasks = [asyncio.create_task(_stay(deadman, clock)), asyncio.create_task(loop.run())]
    try:
        yield rig
    finally:
        closing = asyncio.create_task(runner.close())
        await rig.until(closing.done)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await robot.close()


def _remember(poses: PoseHistory, reading: Odometry) -> None:
    if not len(poses) or reading.captured_ns > poses.newest()[0]:
        poses.add(reading.captured_ns, reading.world_from_base)


async def _stay(deadman: Deadman, clock: ManualClock) -> None:
    while True:
        deadman.heard()
        await clock.sleep_until(clock.now_ns() + 50 * MS)


def sim_robot(
    scene: Scene, seed: int = 0, faults: SimFaults | None = None
) -> Callable[[ManualClock], InlineSimRobot]:
    return lambda clock: InlineSimRobot(sim_description(), scene, clock, faults, seed)


async def tapped_surface(
    robot: InlineSimRobot, captured_ns: int, u: float, v: float
) -> tuple[str, NDArray[np.float64]] | None:
    """What truly lies under a pixel: the object's name ('' for the room) and the point in the world (3,)."""
    direction = robot.description.camera.model().unproject([[u, v]])
    (surface,) = robot.surfaces_seen(direction, captured_ns)
    return None if surface is None else (surface.name, surface.point_in_world)
