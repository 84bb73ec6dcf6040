"""The phase in which the robot looks whether it holds the thing."""

from dataclasses import replace

from tapreach.tasks.fetch.held import HeldVerdict, look_whether_held
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.fetch.thing import ThingSize


async def verify(run: FetchRun) -> Ended:
    """Look whether the thing is in the claw, which then stays closed at the height to which it was lifted.

    What the pictures do not tell counts as not held: it is looked for again.
    """
    if run.memory.zero is None:
        return Ended(Outcome.DONE, "lifted; nobody can tell whether it is held: the claw was not seen before")
    lifted = await run.arm_watch.target()
    width = run.size.width if isinstance(run.size, ThingSize) else 0.0
    found = await look_whether_held(run.context, run.memory.zero, width)
    await run.context.pilot.move_arm(replace(lifted, claw=(await run.arm_watch.target()).claw))
    is_held = found.verdict is HeldVerdict.HELD
    return Ended(Outcome.DONE if is_held else Outcome.MISSED, found.reason)
