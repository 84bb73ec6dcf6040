"""The bench of the online path: what each picture costs while locating, step by step, on one core."""

import random
from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np

from tapreach.bench.figure import Figure, at_most
from tapreach.bench.locate_stage import draw_stage
from tapreach.bench.online_laps import LOOP, WHOLE_FRAME, Laps, RecordingCompute, Stepped, replay
from tapreach.bench.places import SETTLED_S
from tapreach.bench.report import Report, Section
from tapreach.bench.running_robot import running_robot
from tapreach.bench.series import Measurement, run_series
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.robot.clock import Clock, ManualClock
from tapreach.tasks import following
from tapreach.tasks.locate import LocateTask
from tapreach.tasks.task import Tap, TaskContext

RATE_HZ = 30.0
MOST_MS, MOST_LOOP_MS = 10.0, 1.0
_METHOD = (
    "Random taps of the locating bench at 640 by 480 and 30 Hz; the calls of each run are kept and played "
    "again, each step on its own. Processor time of one thread: p50 of all frames, and p95 and the longest."
)


@dataclass(frozen=True)
class OnlinePlan:
    """How many taps, drawn from which seed."""

    seed: int
    taps: int = 12
    is_smoke: bool = False


class _Recorded:
    """The locating task with its calls recorded."""

    kind = "locate"

    def __init__(self, task: LocateTask, compute: RecordingCompute) -> None:
        self._task, self._compute = task, compute
        self.total_ms = 0.0

    async def run(self, context: TaskContext) -> str:
        """See Task."""
        stepped = Stepped(self._task.run(replace(context, compute=self._compute)))
        try:
            return str(await stepped)
        finally:
            self.total_ms = stepped.total_ms


async def run_online(plan: OnlinePlan, on_section: Callable[[Section], None], clock: Clock) -> Report:
    """Run the whole bench."""
    measurement = Measurement("Each picture", lambda: _measure(plan))
    return await run_series(
        "online", "Online path", plan.is_smoke, [measurement], on_section, clock, seed=plan.seed
    )


async def _measure(plan: OnlinePlan) -> Section:
    cv2.setNumThreads(1)
    laps = Laps()
    for number in random.Random(plan.seed).sample(range(10_000), plan.taps):
        await _tap(plan.seed, number, laps)
    return Section("Each picture", _METHOD, tuple(_figures(laps)))


async def _tap(seed: int, number: int, laps: Laps) -> None:
    stage = await draw_stage(seed, number, RATE_HZ)
    clock, compute = ManualClock(), RecordingCompute()
    robot = InlineSimRobot(stage.description, stage.scene, clock, stage.faults, stage.seed)
    async with running_robot(robot, clock) as running:
        robot.place_base(stage.start)
        await running.advance(SETTLED_S)
        tap = Tap(running.newest_frame.frame_id, stage.pixel.u, stage.pixel.v)
        task = _Recorded(LocateTask(tap, 1), compute)
        await running.carry_out(task)
    frames = sum(function is following.follow for function, _, _ in compute.calls)
    laps.note(LOOP, (task.total_ms - compute.total_ms) / max(1, frames))
    replay(compute, stage.description, laps)


def _figures(laps: Laps) -> list[Figure]:
    figures = []
    for step, times in laps.by_step.items():
        middle, late, longest = map(float, np.percentile(times, [50, 95, 100]))
        most = MOST_LOOP_MS if step == LOOP else MOST_MS
        limit = None if step == WHOLE_FRAME else at_most(most)
        note = f"p50 {middle:.2f}, longest {longest:.2f} ms; {len(times)} times"
        figures.append(Figure(f"{step}, p95", late, "ms", limit, note))
    return figures
