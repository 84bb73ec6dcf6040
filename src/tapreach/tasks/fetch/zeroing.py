"""The phase in which the robot looks at its own claw."""

from contextlib import suppress

from tapreach.estimation.arm_offsets import NoOffsets
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.tasks.fetch.approach import Leg
from tapreach.tasks.fetch.approaching import drive
from tapreach.tasks.fetch.arm_leading import ArmBlocked, fold
from tapreach.tasks.fetch.arm_zero import zeroed_arm
from tapreach.tasks.fetch.claw_show_room import WORTH_BACKING, lacking_room
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome
from tapreach.tasks.follower import TargetLost
from tapreach.tasks.free_way import way_behind


async def zero(run: FetchRun) -> Ended:
    """Find out how the servos stand, unless an earlier fetch has; back off first where the claw would hit
    what is known to stand there, as far as the floor behind is known to be free. Raises MotionInterrupted,
    LinkLost.
    """
    if run.memory.zero is not None:
        return Ended(Outcome.DONE, "how the arm stands is known from before")
    back = min(lacking_room(run), way_behind(run.context.poses))
    if back > WORTH_BACKING:
        # What is lost on the way is missed, and looked for, by the phase that needs it.
        with suppress(TargetLost):
            await drive(run, Leg(PlanarStep(0.0, -back), 1.0, sees_thing=True))
    found = await zeroed_arm(run.context)
    try:
        await fold(run)
    except ArmBlocked as blocked:
        return Ended(Outcome.CANNOT, f"the arm does not get out of the picture: {blocked}")
    if isinstance(found.offsets, NoOffsets):
        return Ended(Outcome.DONE, f"the arm is taken as its file says: {found.offsets.reason}")
    run.remember(zero=found)
    return Ended(Outcome.DONE, f"the claw was seen in {found.views} poses")
