"""The task of fetching: carries out the table of states, one phase after the other."""

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace

from tapreach.errors import TapreachError
from tapreach.robot.held_settings import settings_held
from tapreach.tasks.fetch.approaching import approach, last_look
from tapreach.tasks.fetch.arm_watch import ArmWatch
from tapreach.tasks.fetch.arm_zero import ArmZero
from tapreach.tasks.fetch.fetch_state import FetchState, Mode, Verb
from tapreach.tasks.fetch.gripping import back_off, grip, lift, reach
from tapreach.tasks.fetch.looking import end_following, judge_reach, look, plan_of
from tapreach.tasks.fetch.looking_again import keep_what_is_known
from tapreach.tasks.fetch.memory import FetchMemory
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import STATES, Outcome, Phase, is_end, next_phase, resumed_at
from tapreach.tasks.fetch.verifying import verify
from tapreach.tasks.fetch.ways import Ways
from tapreach.tasks.fetch.zeroing import zero
from tapreach.tasks.target import Target
from tapreach.tasks.task import Tap, TaskContext, TaskReport

HELD_VERBS = (Verb.BRING_BACK, Verb.PUT_DOWN, Verb.HAND_OVER)
Step = Callable[[FetchRun], Awaitable[Ended]]


class FetchFailed(TapreachError):
    """It was tried, and did not succeed; says what happened."""


class FetchTask:
    """Fetch what was tapped, as far as `mode` says. Shows the target under `target_id`.

    others: targets that are known beside it; they are kept clear of. zero: the arm as an earlier fetch has
    seen it; None: it is looked at. ways: what it makes use of.
    """

    kind = "fetch"

    def __init__(
        self,
        tap: Tap,
        target_id: int,
        mode: Mode = Mode.GO,
        others: Sequence[Target] = (),
        zero: ArmZero | None = None,
        ways: Ways | None = None,
    ) -> None:
        self.memory = FetchMemory(tap, target_id, mode, zero=zero)
        self._others = tuple(others)
        self.ways = ways or Ways()
        self._confirmed = asyncio.Event()

    def confirm(self) -> None:
        """The operator agrees with the plan."""
        self._confirmed.set()

    def resumed(self, others: Sequence[Target]) -> "FetchTask":
        """Return the task that goes on where this one was stopped."""
        memory = self.memory
        task = FetchTask(memory.tap, memory.target_id, memory.mode, others, ways=self.ways)
        task.memory = replace(memory, phase=resumed_at(memory.phase) or memory.phase)
        return task

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises FetchFailed, and whatever locating and moving raise."""
        obstacles = [each for each in map(Obstacle.of_target, self._others) if each is not None]
        run = FetchRun(context, self.memory, obstacles, ArmWatch(context.robot.arm), self.ways)
        try:
            with settings_held(context.robot.frames):
                return await self._carry_out(run)
        finally:
            if run.memory.phase in (Phase.LOOK, Phase.APPROACH, Phase.LAST_LOOK):
                keep_what_is_known(run)
            self.memory = run.memory
            run.arm_watch.end()
            await end_following(run)

    async def _carry_out(self, run: FetchRun) -> str:
        steps: Mapping[Phase, Step] = {**_STEPS, Phase.CONFIRM: self._confirm}
        why = ""
        if run.memory.called_from is None:
            run.remember(called_from=run.here)
        while not is_end(run.memory.phase):
            self._tell(run, why)
            ended = await steps[run.memory.phase](run)
            why = ended.why
            self._go_on(run, ended.outcome)
        self._tell(run, why)
        return _conclusion(run.memory.phase, why)

    def _go_on(self, run: FetchRun, outcome: Outcome) -> None:
        memory = run.memory
        phase = next_phase(memory.phase, outcome, memory.attempt)
        run.remember(phase=phase, attempt=memory.attempt + (phase is Phase.BACK_OFF))
        self.memory = run.memory

    async def _confirm(self, run: FetchRun) -> Ended:
        await self._confirmed.wait()
        run.remember(is_agreed=True)
        return Ended(Outcome.DONE, "the operator agrees")

    def _tell(self, run: FetchRun, why: str) -> None:
        memory, row = run.memory, STATES[run.memory.phase]
        plan = plan_of(run.preview) if run.preview is not None else None
        verbs = HELD_VERBS if memory.phase is Phase.HELD else ()
        run.context.show_fetch(
            FetchState(memory.phase, memory.target_id, why, memory.attempt, plan, verbs=verbs)
        )
        run.context.report(TaskReport(memory.phase.value, row.progress, row.does))


_STEPS: Mapping[Phase, Step] = {
    Phase.LOOK: look,
    Phase.PREVIEW: judge_reach,
    Phase.ZERO: zero,
    Phase.APPROACH: approach,
    Phase.LAST_LOOK: last_look,
    Phase.REACH: reach,
    Phase.GRIP: grip,
    Phase.LIFT: lift,
    Phase.VERIFY: verify,
    Phase.BACK_OFF: back_off,
}


def _conclusion(phase: Phase, why: str) -> str:
    """Return the closing sentence. Raises FetchFailed for a fetch that was tried in vain."""
    if phase is Phase.FAILED:
        raise FetchFailed(why)
    words = {Phase.HELD: "held", Phase.PLANNED: "planned", Phase.REFUSED: "cannot be fetched"}
    return f"{words[phase]}: {why}"
