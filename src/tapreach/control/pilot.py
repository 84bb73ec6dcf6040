"""What a task may ask of the wheels and the arm. The control loop carries it out, gated like any operator."""

from collections.abc import Callable, Sequence
from typing import Protocol

from tapreach.control.arm_path_motion import TimedPose
from tapreach.errors import TapreachError
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.messages import ArmPose, Odometry
from tapreach.robot.own_moves import OwnMove


class MotionInterrupted(TapreachError):
    """A task's motion was ended by somebody else: cancel, stop, operator gone, robot lost. Says which."""


class Pilot(Protocol):
    """Relative moves by odometry, with ramps. One at a time; every one ends with zero speed.

    Each method raises MotionInterrupted when the gate, the operator or the robot ends the move.
    """

    async def turn(self, angle: float) -> Odometry:
        """Turn on the spot by `angle` [rad, left positive]; return the odometry once at rest."""
        ...

    async def advance(self, distance: float, share: float = 1.0) -> Odometry:
        """Drive straight by `distance` [m, may be negative] at `share` of a task's usual speed; return the
        odometry once at rest.
        """
        ...

    async def move(self, step: PlanarStep, arm: ArmPose | None = None) -> Odometry:
        """Turn and then drive without standing in between, to about there, once the arm is at `arm`.

        Quicker than move_arm, turn and advance after each other. Returns the odometry once at rest.
        """
        ...

    async def move_arm(self, target: ArmPose) -> None:
        """Send the arm to `target` and return when it has come to rest."""
        ...

    async def follow_arm(self, path: Sequence[TimedPose]) -> None:
        """Lead the arm through `path`, each pose at its time, and return when it has come to rest.

        Ended early the arm holds where it is. Raises InputError for times that do not rise.
        """
        ...

    async def carry_out(self, begin: Callable[[], OwnMove], moves_arm: bool = False) -> None:
        """Keep a move of the robot's own alive until it has arrived; see CarryOut.

        moves_arm: it moves the arm alone, and the arm holds where it is ended early.
        """
        ...
