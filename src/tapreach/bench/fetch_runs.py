"""All the runs of a chapter, each kept as soon as it is done."""

from functools import partial

from tapreach.bench.fetch_outcome import FetchOutcome
from tapreach.bench.fetch_plan import Chapter, FetchBenchPlan
from tapreach.bench.fetch_run import run_fetch
from tapreach.bench.kept import Kept
from tapreach.bench.many_runs import Budget, many_runs
from tapreach.robot.clock import Clock


async def run_chapter(
    plan: FetchBenchPlan, chapter: Chapter, budget: Budget, clock: Clock
) -> list[FetchOutcome]:
    """Return the outcomes of every run of a chapter that was done in time, in their order."""
    kept: Kept[list[FetchOutcome]] = Kept(plan.kept, list[FetchOutcome])
    done = {each[0].number: each for each in kept.read() if each and each[0].chapter == chapter}
    numbers = range(plan.runs_of(chapter))
    left = [number for number in numbers if number not in done]
    async for outcomes in many_runs(partial(run_fetch, plan, chapter), left, budget, clock):
        done[outcomes[0].number] = outcomes
        kept.add(outcomes)
    return [outcome for number in sorted(done) for outcome in done[number] if number in numbers]
