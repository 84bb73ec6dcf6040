"""One fetch from the tap to two seconds after its end, in a world of its own, held against the truth."""

from dataclasses import dataclass, replace

from tapreach.bench.fetch_arms import ARM_TASKS
from tapreach.bench.fetch_outcome import FetchOutcome, StopOutcome
from tapreach.bench.fetch_pictures import Glimpse, write_glimpse
from tapreach.bench.fetch_plan import Arm, Chapter, FetchBenchPlan, generator
from tapreach.bench.fetch_stage import FetchStage, draw_fetch_stage
from tapreach.bench.fetch_stops import draw_moment, stop_now
from tapreach.bench.fetch_truth import Standing
from tapreach.bench.fetch_witness import Witness
from tapreach.bench.places import SETTLED_S
from tapreach.bench.running_robot import RunningRobot, running_robot
from tapreach.drivers.sim.inline import InlineSimRobot
from tapreach.drivers.sim.truth import WorldTruth, ask_truth
from tapreach.robot.clock import SECOND, Clock, ManualClock
from tapreach.tasks.fetch.task import FetchTask
from tapreach.tasks.task import Tap

HELD_S = 2.0
"""So long a thing must be held after the end."""
_LOOK_S = 0.1
_FOR_STOPS = 1


@dataclass
class Fetching:
    """One fetch that goes on."""

    running: RunningRobot
    witness: Witness
    standing: Standing
    longest_s: float

    async def carry_on(self, task: FetchTask, until_s: float | None = None) -> bool:
        """Run the task to its end, or up to a time after the tap; return whether it has ended."""
        self.running.start(task)
        while self.running.runner.is_running:
            if until_s is not None and self.witness.seconds >= until_s:
                return False
            if self.witness.seconds >= self.longest_s:
                self.running.runner.cancel(f"not done after {self.longest_s:g} s")
            await self.running.advance(_LOOK_S)
            await self.witness.look()
        return True


async def run_fetch(plan: FetchBenchPlan, chapter: Chapter, number: int, clock: Clock) -> list[FetchOutcome]:
    """Draw the run with this number and return its outcome in every arm.

    Writes a picture of what went wrong to the plan's folder for them. Raises SetupError.
    """
    drawn = await draw_fetch_stage(plan.seed, chapter, number, plan.rate_hz)
    return [await _run_arm(plan, drawn, arm, clock) for arm in plan.arms_of(chapter, number)]


async def _run_arm(plan: FetchBenchPlan, drawn: FetchStage, arm: Arm, clock: Clock) -> FetchOutcome:
    stage, simulated, began_ns = drawn.stage, ManualClock(), clock.now_ns()
    robot = InlineSimRobot(stage.description, stage.scene, simulated, stage.faults, stage.seed, shadows=False)
    witness = Witness(robot, simulated)
    async with running_robot(robot, simulated, witness.hear) as running:
        robot.place_base(stage.start)
        await running.advance(SETTLED_S)
        tapped = running.newest_frame
        standing = Standing(stage.thing, await ask_truth(robot))
        witness.begin(standing)
        task = ARM_TASKS[arm](Tap(tapped.frame_id, stage.pixel.u, stage.pixel.v))
        fetching = Fetching(running, witness, standing, plan.longest_s)
        stop = await _carry_out(fetching, task, _moment(plan, drawn))
        outcome = replace(
            await _outcome(fetching, drawn, arm, stop), wall_seconds=(clock.now_ns() - began_ns) / SECOND
        )
        if plan.folder is not None and not outcome.is_good:
            glimpse = Glimpse(tapped.jpeg, stage.pixel.to_array(), running.newest_frame.jpeg)
            write_glimpse(plan.folder, glimpse, outcome)
    return outcome


def _moment(plan: FetchBenchPlan, drawn: FetchStage) -> float | None:
    """Return when the operator stops [s after the tap]; None where nobody does."""
    if drawn.chapter is not Chapter.STOPS:
        return None
    rng = generator(plan.seed, drawn.chapter, drawn.stage.number, _FOR_STOPS)
    return min(draw_moment(rng), plan.longest_s / 2.0)


async def _carry_out(fetching: Fetching, task: FetchTask, moment: float | None) -> StopOutcome | None:
    """Run the task to its end; where it is stopped on the way, resume it and return what the stop did."""
    if await fetching.carry_on(task, moment):
        return None
    stop = await stop_now(fetching.running, fetching.witness, fetching.standing)
    await fetching.carry_on(task.resumed(()))
    held = fetching.standing.is_held(await ask_truth(fetching.running.robot))
    return replace(stop, resumed=held)


async def _outcome(fetching: Fetching, drawn: FetchStage, arm: Arm, stop: StopOutcome | None) -> FetchOutcome:
    stage, witness, standing = drawn.stage, fetching.witness, fetching.standing
    progress, seconds = fetching.running.progress, witness.seconds
    at_end = await ask_truth(fetching.running.robot)
    await fetching.running.advance(HELD_S)
    after = await ask_truth(fetching.running.robot)
    return FetchOutcome(
        chapter=drawn.chapter.value,
        number=stage.number,
        arm=arm.value,
        scene=stage.scene_name,
        thing=stage.thing or str(drawn.hindrance),
        distance=stage.distance,
        is_way_free=drawn.is_way_free,
        state=progress.state.value,
        phase=witness.phase.value if witness.phase is not None else "",
        note=progress.message,
        attempt=witness.told[-1].attempt if witness.told else 1,
        is_held=standing.is_held(at_end) and standing.is_held(after),
        lift=standing.lift(after),
        lifted_after=witness.lifted_after,
        is_denied=witness.is_denied,
        seconds=seconds,
        wall_seconds=0.0,
        others_moved=standing.others_moved(after),
        most_moved=_most_moved(standing, after),
        phases=tuple(witness.phases),
        hindrance=drawn.hindrance,
        stop=stop,
    )


def _most_moved(standing: Standing, after: WorldTruth) -> float:
    return max(standing.moves(after).values(), default=0.0)
