"""All the taps of a run, each kept as soon as it is done."""

from functools import partial

from tapreach.bench.kept import Kept
from tapreach.bench.locate_outcome import Outcome
from tapreach.bench.locate_plan import LocatePlan
from tapreach.bench.locate_run import run_tap
from tapreach.bench.many_runs import Budget, many_runs
from tapreach.robot.clock import Clock


async def run_taps(plan: LocatePlan, clock: Clock) -> list[Outcome]:
    """Return the outcomes of every tap that was done in time, in their order."""
    kept: Kept[list[Outcome]] = Kept(plan.kept, list[Outcome])
    done = {outcomes[0].tap: outcomes for outcomes in kept.read() if outcomes}
    left = [number for number in range(plan.taps) if number not in done]
    budget = Budget.of(plan.jobs, plan.minutes, clock)
    async for outcomes in many_runs(partial(run_tap, plan), left, budget, clock):
        done[outcomes[0].tap] = outcomes
        kept.add(outcomes)
    return [outcome for number in sorted(done) for outcome in done[number] if number < plan.taps]
