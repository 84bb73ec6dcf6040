"""The Pilot that tasks are given: motions handed to the control loop."""

from collections.abc import Sequence

from tapreach.control.arm_move import ArmMove
from tapreach.control.arm_path_motion import ArmPathMotion, TimedPose
from tapreach.control.joined_motion import ArmFirst, InTurn, Rest
from tapreach.control.loop import ControlLoop
from tapreach.control.motion import Motion
from tapreach.control.relative_move import ABOUT, ABOUT_TURN, Advance, Turn, slowed
from tapreach.geometry.planar_motion import PlanarStep
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

    async def advance(self, distance: float, share: float = 1.0) -> Odometry:
        """See Pilot."""
        return await self._loop.carry_out(Advance(distance, slowed(self._robot.description.base, share)))

    async def move(self, step: PlanarStep, arm: ArmPose | None = None) -> Odometry:
        """See Pilot."""
        base = self._robot.description.base
        wheels: list[Motion] = [Rest()]
        if abs(step.advance) > ABOUT:
            wheels.insert(0, Advance(step.advance, base, is_exact=False))
        if abs(step.turn) > ABOUT_TURN:
            wheels.insert(0, Turn(step.turn, base, is_exact=False))
        motion: Motion = InTurn(wheels)
        if arm is not None and not self._is_at(arm):
            motion = ArmFirst(motion, ArmMove(self._loop.move_arm, arm))
        return await self._loop.carry_out(motion)

    def _is_at(self, pose: ArmPose) -> bool:
        state = self._loop.senses.arm
        return state is not None and not state.is_moving and self._loop.arm_target == pose

    async def move_arm(self, target: ArmPose) -> None:
        """See Pilot."""
        await self._loop.carry_out(ArmMove(self._loop.move_arm, target))

    async def follow_arm(self, path: Sequence[TimedPose]) -> None:
        """See Pilot."""
        await self._loop.carry_out(ArmPathMotion(self._loop.move_arm, path))
