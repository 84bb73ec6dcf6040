"""A whole robot in simulated time, as fast as the machine allows: world, camera, control loop, operator."""

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import TypeGuard, TypeVar

from tapreach.bench.ending import finish
from tapreach.control.authority import Authority
from tapreach.control.deadman import Deadman
from tapreach.control.emergency_stop import EmergencyStop
from tapreach.control.lease import Lease
from tapreach.control.loop import ControlLoop
from tapreach.control.loop_pilot import LoopPilot
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.errors import LinkLost
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.estimation.pose_history import PoseHistory
from tapreach.robot.clock import MS, SECOND, ManualClock
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.messages import Frame, Odometry
from tapreach.tasks.compute import InlineCompute
from tapreach.tasks.fetch.fetch_state import FetchState
from tapreach.tasks.runner import TaskProgress, TaskRunner
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target import Target
from tapreach.tasks.task import Task, TaskContext

T = TypeVar("T")
_OPERATOR = 1
_CAMERA_SILENCE_NS = 2 * SECOND
_LONGEST_TASK_S = 90.0


class WatchedCompute(InlineCompute):
    """Computes in place, in no simulated time, and remembers the last estimate and what it rests on."""

    def __init__(self) -> None:
        self.estimate: PointEstimate | None = None
        self.sightings: Sequence[Sighting] = ()

    async def call(self, function: Callable[..., T], *arguments: object) -> T:
        """See Compute."""
        result = await super().call(function, *arguments)
        if isinstance(result, PointEstimate):
            self.estimate = result
            self.sightings = next((each for each in arguments if _are_sightings(each)), ())
        return result


def _are_sightings(argument: object) -> TypeGuard[Sequence[Sighting]]:
    return isinstance(argument, list | tuple) and bool(argument) and isinstance(argument[0], Sighting)


class _Frames:
    """Stores what the camera sends and lets tasks wait for the next."""

    def __init__(self, robot: InlineSimRobot, clock: ManualClock) -> None:
        self.store = FrameStore()
        self._clock = clock
        robot.frames.subscribe(self.store.add)

    async def next_frame(self, frame_id: int) -> Frame:
        until_ns = self._clock.now_ns() + _CAMERA_SILENCE_NS
        while (newest := self.store.newest) is None or newest.frame_id <= frame_id:
            if self._clock.now_ns() >= until_ns:
                raise LinkLost("no picture for 2 s")
            await self._clock.sleep_until(self._clock.now_ns() + 5 * MS)
        return newest


@dataclass
class RunningRobot:
    """Everything, running; the time stands still but for `advance` and `carry_out`."""

    clock: ManualClock
    robot: InlineSimRobot
    runner: TaskRunner
    context: TaskContext
    compute: WatchedCompute
    loop: ControlLoop
    target: Target | None = None
    """The last that was shown."""

    @property
    def newest_frame(self) -> Frame:
        """The newest picture; there must be one."""
        frame = self.context.frames.newest
        assert frame is not None
        return frame

    async def advance(self, seconds: float) -> None:
        """Let simulated time pass."""
        await self.clock.advance(round(seconds * SECOND))

    async def carry_out(self, task: Task, longest_s: float = _LONGEST_TASK_S) -> TaskProgress:
        """Run a task to its end, or for `longest_s` at most, and return how it ended."""
        end_ns = self.clock.now_ns() + round(longest_s * SECOND)
        self.start(task)
        while self.runner.is_running:
            if self.clock.now_ns() >= end_ns:
                self.runner.cancel(f"not done after {longest_s:g} s")
            await self.clock.advance(10 * MS)
        return self.progress

    def start(self, task: Task) -> None:
        """Start a task as the operator does; `advance` then lets it go on."""
        self.runner.start(task, _OPERATOR)

    @property
    def progress(self) -> TaskProgress:
        """How the newest task goes; there must be one."""
        assert self.runner.progress is not None
        return self.runner.progress


@asynccontextmanager
async def running_robot(
    robot: InlineSimRobot,
    clock: ManualClock,
    show_fetch: Callable[[FetchState | None], None] = lambda _: None,
) -> AsyncIterator[RunningRobot]:
    """Run everything around `robot` while the block runs, with an operator who never lets go.

    show_fetch: hears where fetching stands. Raises SetupError when nothing can draw.
    """
    poses, frames = PoseHistory(), _Frames(robot, clock)
    robot.base.subscribe(lambda reading: _remember(poses, reading))
    deadman, lease = Deadman(clock), Lease(clock)
    authority = Authority(robot, clock, lease, deadman, EmergencyStop(clock, lambda: None))
    loop = ControlLoop(authority)
    compute = WatchedCompute()
    context = TaskContext(
        description=robot.description,
        robot=robot,
        pilot=LoopPilot(loop, robot),
        frames=frames.store,
        poses=poses,
        compute=compute,
        clock=clock,
        next_frame=frames.next_frame,
        report=lambda report: None,
        show_target=lambda target: setattr(running, "target", target),
        show_fetch=show_fetch,
    )
    runner = TaskRunner(context, loop, lambda progress: None)
    running = RunningRobot(clock, robot, runner, context, compute, loop)
    await robot.connect()
    lease.request(_OPERATOR)
    beside = [asyncio.create_task(_stay(deadman, clock)), asyncio.create_task(loop.run())]
    try:
        yield running
    finally:
        for task in beside:
            await finish(task)
        await robot.close()


def _remember(poses: PoseHistory, reading: Odometry) -> None:
    if not len(poses) or reading.captured_ns > poses.newest()[0]:
        poses.add(reading.captured_ns, reading.world_from_base)


async def _stay(deadman: Deadman, clock: ManualClock) -> None:
    while True:
        deadman.heard()
        await clock.sleep_until(clock.now_ns() + 50 * MS)
