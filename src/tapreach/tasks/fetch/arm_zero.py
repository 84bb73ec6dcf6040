"""The robot looks at its own claw, once, and then knows where it is in its camera's pictures.

Hobby servos stand off their zeros by degrees, which is centimetres at the finger tips, and the camera's
mount is not quite what its file says. What is to be gripped is seen by the same camera; so it is enough to
know the claw as that camera sees it.
"""

from dataclasses import dataclass, replace

from scipy.spatial.transform import RigidTransform

from tapreach.estimation.arm_offsets import ArmOffsets, NoOffsets
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.seen_arm import SeenArm
from tapreach.robot.clock import MS
from tapreach.robot.messages import ArmPose, Frame
from tapreach.tasks.fetch.claw_looking import ClawPictures, ClawReading, arm_noise, read_claw
from tapreach.tasks.fetch.looking_poses import LookingPose, looking_poses, openings
from tapreach.tasks.task import TaskContext, TaskReport

LATEST_STAMP_NS = 200 * MS
"""A picture may be older than its stamp says by so much: delay of the camera that nobody knows of."""
MORE_LOOKS = 2


@dataclass(frozen=True, eq=False)
class ArmZero:
    """The arm as the camera sees it, or why it could not be told; views: poses in which the claw was seen."""

    offsets: ArmOffsets | NoOffsets
    views: int

    def seen_arm(self, base_from_camera: RigidTransform) -> SeenArm | None:
        """Return the arm in the frame in which the camera's things are placed, by a mount `base_from_camera`.

        None where the zeros could not be told.
        """
        if isinstance(self.offsets, NoOffsets):
            return None
        seen_from_base = base_from_camera * self.offsets.base_from_camera.inv()
        return SeenArm(self.offsets.arm, self.offsets.zeros, seen_from_base)


async def zeroed_arm(context: TaskContext, poses: int = 4) -> ArmZero:
    """Look at the claw in `poses` poses, opened and narrow, with the base at rest; less than 2 s for each.

    Where it was not seen at first, since it stood far off, it is looked at again, up to MORE_LOOKS times.
    Raises MotionInterrupted when it is stopped (the arm stays where it is), LinkLost when the camera falls
    silent.
    """
    chosen = await context.compute.call(looking_poses, context.description, arm_noise(), poses)
    if not chosen:
        return ArmZero(NoOffsets("the camera of this robot does not see where its claw can be"), 0)
    pictures: list[ClawPictures] = []
    reading = ClawReading(NoOffsets("the claw was not looked at"), ())
    for number, pose in enumerate((*chosen, *chosen[:MORE_LOOKS])):
        if reading.views >= len(chosen):
            break
        context.report(TaskReport("zero", number / len(chosen), "looking where the claw is"))
        pictures.append(await _pictures(context, _sent(pose, reading, context), number % 2 == 1))
        reading = await context.compute.call(read_claw, tuple(pictures), context.description)
    return ArmZero(reading.offsets, reading.views)


async def frame_at_rest(context: TaskContext) -> Frame:
    """Return a picture surely taken after now, however late the camera's pictures are."""
    after_ns = context.clock.now_ns() + LATEST_STAMP_NS
    frame = context.frames.newest
    while frame is None or frame.captured_ns < after_ns:
        frame = await context.next_frame(0 if frame is None else frame.frame_id)
    return frame


def _sent(pose: LookingPose, reading: ClawReading, context: TaskContext) -> ArmJoints:
    """Return what to send for the pose, by what is known of the arm so far."""
    zero = ArmZero(reading.offsets, 0).seen_arm(context.description.camera.mount.base_from_camera())
    reach = None if zero is None else zero.inverse(pose.tip, near=pose.joints)
    return pose.joints if reach is None or reach.joints is None else reach.joints


async def _pictures(context: TaskContext, sent: ArmJoints, is_narrow_first: bool) -> ClawPictures:
    """Take both pictures; the claw stays as it is from one pose to the next."""
    wide, narrow = openings(context.description)
    target = ArmPose(sent.rotation, sent.shoulder, sent.elbow, narrow if is_narrow_first else wide)
    await context.pilot.move_arm(target)
    first = await frame_at_rest(context)
    await context.pilot.move_arm(replace(target, claw=wide if is_narrow_first else narrow))
    second = await frame_at_rest(context)
    opened, closed = (second, first) if is_narrow_first else (first, second)
    return ClawPictures(sent, wide, narrow, opened.jpeg, closed.jpeg)
