"""Measuring how late the camera is, as a task of its own."""

from tapreach.errors import TapreachError
from tapreach.estimation.camera_delay import NoDelay
from tapreach.robot.held_settings import settings_held
from tapreach.tasks.camera_delay import in_words, measured_delay
from tapreach.tasks.task import TaskContext, TaskReport


class DelayUnknown(TapreachError):
    """The robot turned and watched, and how late its camera is cannot be told; says why."""


class DelayTask:
    """Turn to and fro, watch, and keep what was found for all tasks; see camera_delay."""

    kind = "camera delay"

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises DelayUnknown, MotionInterrupted, LinkLost."""
        context.report(TaskReport("camera", 0.0, "turning a little to see how late the camera is"))
        with settings_held(context.robot.frames):
            found = await measured_delay(context)
        if isinstance(found, NoDelay):
            raise DelayUnknown(in_words(found))
        context.camera_delay.known = found
        return in_words(found)
