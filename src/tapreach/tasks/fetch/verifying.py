"""The phase in which the robot looks whether it holds the thing."""

from dataclasses import replace

from tapreach.tasks.fetch.held import Held, HeldVerdict, look_whether_held
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome


async def verify(run: FetchRun) -> Ended:
    """Look whether the thing is in the claw, twice where the first look does not tell; the claw then stays
    closed, at the height to which it was lifted.
    """
    if run.memory.zero is None:
        return Ended(Outcome.DONE, "lifted; nobody can tell whether it is held: the claw was not seen before")
    lifted = await run.arm_watch.target()
    found = await look_whether_held(run.context, run.memory.zero)
    if found.verdict is HeldVerdict.UNSURE:
        found = _surer(found, await look_whether_held(run.context, run.memory.zero))
    await run.context.pilot.move_arm(replace(lifted, claw=(await run.arm_watch.target()).claw))
    is_held = found.verdict is not HeldVerdict.NOT_HELD and found.log_odds > 0.0
    return Ended(Outcome.DONE if is_held else Outcome.MISSED, found.reason)


def _surer(first: Held, second: Held) -> Held:
    return max(first, second, key=lambda held: abs(held.log_odds))
