"""Where the base was when a frame was captured, waiting a moment for odometry that is still on its way."""

from tapreach.errors import PoseNotYetKnown
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.clock import MS, SECOND
from tapreach.tasks.task import TaskContext

_PATIENCE_NS = SECOND


async def pose_at(context: TaskContext, captured_ns: int) -> PlanarPose:
    """Return world_from_base when a frame with this time stamp was truly taken, as far as the camera's delay
    is known. Raises PoseExpired, and PoseNotYetKnown after waiting for a second.
    """
    until_ns = context.clock.now_ns() + _PATIENCE_NS
    while True:
        try:
            return context.poses.at(context.camera_delay.taken_ns(captured_ns))
        except PoseNotYetKnown:
            if context.clock.now_ns() >= until_ns:
                raise
        await context.clock.sleep_until(context.clock.now_ns() + 10 * MS)
