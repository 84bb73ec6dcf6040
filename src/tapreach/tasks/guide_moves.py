"""What the robot does for a guide, each as a small task: gated, shown and stopped like any other."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from math import degrees

from tapreach.control.pilot import Pilot
from tapreach.tasks.task import TaskContext, TaskReport


@dataclass(frozen=True, slots=True)
class GuideMove:
    """A Task of one motion."""

    kind: str
    sentence: str
    motion: Callable[[Pilot], Awaitable[object]]

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises MotionInterrupted."""
        context.report(TaskReport("move", 0.0, self.sentence))
        await self.motion(context.pilot)
        return f"done: {self.sentence}"


def turn_move(angle: float) -> GuideMove:
    """Turn by `angle` [rad, left positive]."""
    return GuideMove("guide", f"turning {in_words(angle)}", lambda pilot: pilot.turn(angle))


def advance_move(distance: float) -> GuideMove:
    """Drive straight by `distance` [m]."""
    return GuideMove("guide", f"driving {100.0 * distance:.1f} cm", lambda pilot: pilot.advance(distance))


def pose_move(context: TaskContext) -> GuideMove:
    """Bring the arm to its standard pose."""
    standard = context.description.arm.standard.pose()
    return GuideMove("guide", "bringing the arm to its standard pose", lambda pilot: pilot.move_arm(standard))


def in_words(angle: float) -> str:
    """Return a turn as a person says it: '3.0° right'."""
    return f"{abs(degrees(angle)):.1f}° {'left' if angle >= 0.0 else 'right'}"
