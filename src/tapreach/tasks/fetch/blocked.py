"""What is done when something blocks the robot on its way to the thing."""

from tapreach.tasks.fetch.outline import Outline
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.free_way import way_behind

BACK = 0.12
"""So far the robot backs off to have room for a turn [m], over floor it came by."""


async def back_off_from(run: FetchRun, why: str) -> Ended | None:
    """Back off from what blocks the robot, and remember that it stands there, so that the next leg leads
    round it; end instead where it is not the first time. Raises MotionInterrupted, LinkLost.
    """
    if run.memory.was_blocked:
        return Ended(Outcome.CANNOT, f"{why} once more")
    run.remember(was_blocked=True)
    run.around.bumped_into(run.here, Outline.of(run.context.description).front)
    await run.context.pilot.advance(-min(BACK, way_behind(run.context.poses)))
    return None
