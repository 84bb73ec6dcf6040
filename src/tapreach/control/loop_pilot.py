"""The Pilot that tasks are given: motions handed to the control loop."""

from collections.abc import Callable, Sequence

from tapreach.control.arm_move import ArmMove
from tapreach.control.arm_path_motion import ArmPathMotion, TimedPose
from tapreach.control.joined_motion import ArmFirst, InTurn, Rest
from tapreach.control.loop import ControlLoop
from tapreach.control.motion import Motion
from tapreach.control.own_step import OwnMotion, OwnStep
from tapreach.control.relative_move import ABOUT, ABOUT_TURN, Advance, Turn, slowed
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.interface import Robot
from tapreach.robot.messages import ArmPose, Odometry
from tapreach.robot.own_moves import MovesByItself, OwnMove


class LoopPilot:
    """See Pilot. Where the robot turns and advances by itself, that is one command to it."""

    def __init__(self, loop: ControlLoop, robot: Robot) -> None:
        self._loop = loop
        self._robot = robot

    async def turn(self, angle: float) -> Odometry:
        """See Pilot."""
        own = self._by_itself(PlanarStep(angle, 0.0))
        return await self._loop.carry_out(own or Turn(angle, self._robot.description.base))

    async def advance(self, distance: float, share: float = 1.0) -> Odometry:
        """See Pilot."""
        own = self._by_itself(PlanarStep(0.0, distance), share)
        motion = own or Advance(distance, slowed(self._robot.description.base, share))
        return await self._loop.carry_out(motion)

    async def move(self, step: PlanarStep, arm: ArmPose | None = None) -> Odometry:
        """See Pilot."""
        motion = self._by_itself(step) or self._about(step)
        if arm is not None and not self._is_at(arm):
            motion = ArmFirst(motion, ArmMove(self._loop.move_arm, arm))
        return await self._loop.carry_out(motion)

    def _by_itself(self, step: PlanarStep, share: float = 1.0) -> Motion | None:
        base = self._robot.base
        return InTurn([OwnStep(base, step, share), Rest()]) if isinstance(base, MovesByItself) else None

    def _about(self, step: PlanarStep) -> Motion:
        base = self._robot.description.base
        wheels: list[Motion] = [Rest()]
        if abs(step.advance) > ABOUT:
            wheels.insert(0, Advance(step.advance, base, is_exact=False))
        if abs(step.turn) > ABOUT_TURN:
            wheels.insert(0, Turn(step.turn, base, is_exact=False))
        return InTurn(wheels)

    def _is_at(self, pose: ArmPose) -> bool:
        state = self._loop.senses.arm
        return state is not None and not state.is_moving and self._loop.arm_target == pose

    async def move_arm(self, target: ArmPose) -> None:
        """See Pilot."""
        await self._loop.carry_out(ArmMove(self._loop.move_arm, target))

    async def follow_arm(self, path: Sequence[TimedPose]) -> None:
        """See Pilot."""
        await self._loop.carry_out(ArmPathMotion(self._loop.move_arm, path))

    async def carry_out(self, begin: Callable[[], OwnMove], moves_arm: bool = False) -> None:
        """See Pilot."""
        await self._loop.carry_out(OwnMotion(begin, moves_arm))
