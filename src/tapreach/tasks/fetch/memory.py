"""What fetching remembers, so that it can go on after a stop and do something with what it holds."""

from dataclasses import dataclass

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_zero import ArmZero
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.states import FIRST, Phase
from tapreach.tasks.task import Tap


@dataclass(frozen=True)
class FetchMemory:
    """Replaced as fetching goes on; the world is that of the present odometry.

    tap: on the frame that names the thing. attempt, looks: of gripping and of locating, counted from 1.
    called_from: where the base stood when it was called. point_in_world (3,) [m]: the tapped place, None
    before it is located. gripped_at: the arm's pose when the claw closed, None while nothing has been
    gripped. zero: the arm as it was seen. way: where the base has been since.
    """

    tap: Tap
    target_id: int
    mode: Mode
    phase: Phase = FIRST
    attempt: int = 1
    looks: int = 1
    called_from: PlanarPose | None = None
    point_in_world: FloatArray | None = None
    gripped_at: ArmPose | None = None
    zero: ArmZero | None = None
    way: tuple[PlanarPose, ...] = ()
