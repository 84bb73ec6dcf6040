"""Leading the arm along clear ways, from wherever it was last sent."""

from collections.abc import Sequence

import numpy.typing as npt

from tapreach.errors import TapreachError
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_path import TIP_SPEED, ArmPath, path_to, straight_path
from tapreach.tasks.fetch.arm_workspace import Unreachable
from tapreach.tasks.fetch.run import FetchRun


class ArmBlocked(TapreachError):
    """The arm cannot go where it should; says why."""


async def lead_to(run: FetchRun, pose: ArmPose, by_way_of: Sequence[ArmPose] = ()) -> None:
    """Lead the arm to `pose`, over one of `by_way_of` where the direct way is not clear.

    Raises ArmBlocked.
    """
    start = await run.arm_watch.target()
    if start != pose:
        await lead(run, path_to(start, pose, run.arm, by_way_of))


async def lead_straight(run: FetchRun, tip_in_base: npt.ArrayLike, tip_speed: float = TIP_SPEED) -> None:
    """Lead the finger tips straight to (3,) in the arm's base frame [m]. Raises ArmBlocked."""
    await lead(run, straight_path(await run.arm_watch.target(), tip_in_base, run.arm), tip_speed)


async def lead(run: FetchRun, path: ArmPath | Unreachable, tip_speed: float = TIP_SPEED) -> None:
    """Lead the arm along `path`. Raises ArmBlocked where there is none."""
    if isinstance(path, Unreachable):
        raise ArmBlocked(path.reason)
    await run.context.pilot.follow_arm(path.timed(run.arm, tip_speed))


async def fold(run: FetchRun) -> None:
    """Bring the arm out of the picture. Raises ArmBlocked."""
    poses = run.context.description.arm
    await lead_to(run, poses.standard.pose(), [poses.stowed.pose()])
