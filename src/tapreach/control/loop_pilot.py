"""The Pilot that tasks are given: motions handed to the control loop."""

from tapreach.control.arm_move import ArmMove
from tapreach.control.loop import ControlLoop
from tapreach.control.relative_move import Advance, Turn
from tapreach.robot.interface import Robot
from tapreach.robot.messages import ArmPose, Odometry


class LoopPilot:
    """See Pilot."""

    def __init__(self, loop: ControlLoop, robot: Robot) -> None:
        self._loop = loop
        self._robot = robot

    async def turn(self, angle: float) -> Odometry:
        """See Pilot."""
        return await self._loop.carry_out(Turn(angle, self._robot.description.base))

    async def advance(self, distance: float) -> Odometry:
        """See Pilot."""
        return await self._loop.carry_out(Advance(distance, self._robot.description.base))

    async def move_arm(self, target: ArmPose) -> None:
        """See Pilot."""
        await self._loop.carry_out(ArmMove(self._loop.move_arm, target))
