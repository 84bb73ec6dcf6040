"""The phase in which the robot looks at its own claw."""

from tapreach.estimation.arm_offsets import NoOffsets
from tapreach.tasks.fetch.arm_leading import ArmBlocked, fold
from tapreach.tasks.fetch.arm_zero import zeroed_arm
from tapreach.tasks.fetch.run import Ended, FetchRun
from tapreach.tasks.fetch.states import Outcome


async def zero(run: FetchRun) -> Ended:
    """Find out how the servos stand, unless an earlier fetch has. Raises MotionInterrupted, LinkLost."""
    if run.memory.zero is not None:
        return Ended(Outcome.DONE, "how the arm stands is known from before")
    found = await zeroed_arm(run.context)
    try:
        await fold(run)
    except ArmBlocked as blocked:
        return Ended(Outcome.CANNOT, f"the arm does not get out of the picture: {blocked}")
    if isinstance(found.offsets, NoOffsets):
        return Ended(Outcome.DONE, f"the arm is taken as its file says: {found.offsets.reason}")
    run.remember(zero=found)
    return Ended(Outcome.DONE, f"the claw was seen in {found.views} poses")
