"""A move that a task is about to make, as it is told and shown before."""

import math
from dataclasses import dataclass

from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.robot.config import RobotDescription
from tapreach.tasks.move_choice import Choice

LEAST_TURN = math.radians(2.0)
"""Smaller turns are not worth a word."""
_REAR = 0.06
"""How far the body reaches behind the wheel axis [m]."""
_BEYOND_CAMERA, _BESIDE_WHEEL = 0.03, 0.02


@dataclass(frozen=True)
class PlannedMove:
    """Turn on the spot and then advance, from world_from_base `start`; what it is expected to bring.

    expected_sd [m]: one sigma of the range after it; expected_relative_sd: the same as a share of the range.
    """

    start: PlanarPose
    step: PlanarStep
    expected_sd: float
    expected_relative_sd: float

    @classmethod
    def of(cls, choice: Choice, start: PlanarPose) -> "PlannedMove":
        """Return the move that was chosen at `start`."""
        return cls(start, choice.step, choice.sd, choice.relative_sd)

    @property
    def end(self) -> PlanarPose:
        """world_from_base after it."""
        return self.start.after(self.step)

    @property
    def in_words(self) -> str:
        """Such as 'turning 12° left, then driving 0.30 m forward'."""
        step = self.step
        side, way = "left" if step.turn > 0.0 else "right", "forward" if step.advance >= 0.0 else "back"
        turn = f"turning {abs(math.degrees(step.turn)):.0f}° {side}, then " if self._turns else ""
        return f"{turn}driving {abs(step.advance):.2f} m {way}"

    @property
    def _turns(self) -> bool:
        return abs(self.step.turn) > LEAST_TURN


def wheel_tracks(move: PlannedMove, description: RobotDescription) -> tuple[tuple[PlanarPose, ...], ...]:
    """Return where the left and the right side of the robot will go, as poses on the floor, start to end."""
    half = _half_width(description)
    turned = move.start.after(PlanarStep(move.step.turn, 0.0))
    stages = [turned.after(PlanarStep(0.0, move.step.advance * i / 6.0)) for i in range(7)]
    return tuple(tuple(pose.compose(PlanarPose(0.0, side, 0.0)) for pose in stages) for side in (half, -half))


def footprint(move: PlannedMove, description: RobotDescription) -> tuple[PlanarPose, ...]:
    """Return the corners of the robot's body at the end of the move, as poses on the floor, around it."""
    half = _half_width(description)
    front = max(description.camera.mount.forward, 0.05) + _BEYOND_CAMERA
    corners = ((-_REAR, half), (front, half), (front, -half), (-_REAR, -half))
    return tuple(move.end.compose(PlanarPose(x, y, 0.0)) for x, y in corners)


def _half_width(description: RobotDescription) -> float:
    return 0.5 * description.base.track_width + _BESIDE_WHEEL
