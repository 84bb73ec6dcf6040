"""What fetching remembers, so that it can go on after a stop and do something with what it holds."""

from dataclasses import dataclass

from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.messages import ArmPose
from tapreach.tasks.fetch.arm_zero import ArmZero
from tapreach.tasks.fetch.fetch_state import Mode
from tapreach.tasks.fetch.known_thing import KnownThing
from tapreach.tasks.fetch.states import FIRST, Phase
from tapreach.tasks.task import Tap
from tapreach.vision.tapped_colours import TappedSpot


@dataclass(frozen=True)
class FetchMemory:
    """Replaced as fetching goes on; the world is that of the present odometry.

    tap: on the frame that names the thing. attempt, looks: of gripping and of locating, counted from 1.
    called_from: where the base stood when it was called. known: what the newest look has told, None before
    the first. seen_again: where the thing was seen after a miss, None where it was not. gripped_at: the arm's
    pose when the claw closed, None while nothing has been gripped. zero: the arm as it was seen. way: where
    the base has been since. other_sides: how often it was too wide from near, and another side was sought.
    missed_from: directions in the world of the claw when it closed in vain [rad].
    was_blocked: something on the way has blocked the robot. tapped: how the spot looked that the operator
    tapped, once its distance is known. is_agreed: the operator was asked, and agreed.
    """

    tap: Tap
    target_id: int
    mode: Mode
    phase: Phase = FIRST
    attempt: int = 1
    looks: int = 1
    called_from: PlanarPose | None = None
    known: KnownThing | None = None
    seen_again: Tap | None = None
    gripped_at: ArmPose | None = None
    zero: ArmZero | None = None
    way: tuple[PlanarPose, ...] = ()
    other_sides: int = 0
    missed_from: tuple[float, ...] = ()
    was_blocked: bool = False
    tapped: TappedSpot | None = None
    is_agreed: bool = False
