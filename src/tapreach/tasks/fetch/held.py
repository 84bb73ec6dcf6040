"""Whether the thing is held: the claw is told to close fully and then looked at in two poses or more.

An empty claw closes until its fingers meet; a thing keeps them apart. Whether they are apart is seen in what
differs between pictures with the arm in different places (vision/held.py): no colour needs to be known, and
what lies or stands behind the claw does not move. Servos that tell where they are, are heard as well.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from tapreach.estimation.arm_offsets import ArmOffsets, NoOffsets
from tapreach.estimation.claw_sight import SightModel
from tapreach.geometry.arm_clearance import ArmShape, Capsule, arm_capsules
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.robot.messages import ArmPose, ArmState
from tapreach.tasks.fetch.arm_zero import ArmZero, frame_at_rest
from tapreach.tasks.fetch.line_of_sight import is_hidden
from tapreach.tasks.task import TaskContext, TaskReport
from tapreach.vision.claw_motion import change_between
from tapreach.vision.held import AcrossClaw, claw_width
from tapreach.vision.image_io import BrokenPicture, Color, decode_color
from tapreach.vision.steadied import steadied

SURE = 5.0
"""Log odds beyond which a verdict is given: a hundred and fifty to one."""
BY_SERVO = 5.0
"""What a servo that stopped short of closing adds to the log odds."""
MOST_DISAGREEMENT = 0.2
"""Share of what was seen across the claw that no width of it explains, beyond which there is no verdict."""
STOPPED_SHORT = 0.006
"""Opening at which a claw that was told to close tells of something between its fingers [m]."""
LEAST_THING = 0.018
"""Things narrower than this [m] cannot be told from nothing."""
_LEAST_SHARE = 0.6
"""Of the width the thing was seen to have: the fingers are at least so far apart when they hold it."""
_AHEAD = (0.3, 0.6, 0.9)
_UP = (0.4, 0.7, 0.95)
"""Where across the fingers it is looked: shares of how far they reach ahead and up."""
_STEP, _BEYOND = 0.0015, 0.008
_AWAY, _SHOWN = (0.14, -0.09, 0.17), ((0.175, 0.03, 0.09), (0.19, 0.06, 0.11), (0.165, 0.0, 0.08))
"""Where the tips are held away and where shown, before one background after the other: ahead and left of the
camera, above the floor [m]."""


class HeldVerdict(StrEnum):
    """What can be said."""

    HELD = "held"
    NOT_HELD = "not_held"
    UNSURE = "unsure"


@dataclass(frozen=True)
class Held:
    """verdict, why, how far apart the fingers seem to be [m], and the log odds of something being held."""

    verdict: HeldVerdict
    reason: str
    opening: float
    log_odds: float


@dataclass(frozen=True, slots=True)
class HeldPicture:
    """A picture (JPEG) with base and arm at rest, servos sent to `sent`, the claw told to close."""

    sent: ArmJoints
    jpeg: bytes


async def look_whether_held(context: TaskContext, zero: ArmZero, thing_width: float = 0.0) -> Held:
    """Close the claw fully, look at it in two poses, and in more as long as they do not tell, and say
    whether there is something in it.

    thing_width [m]: as it was seen before, 0 for not known; knowing it makes the verdict surer. For a claw
    lifted clear of what stands on the floor, with the base at rest; about 1 s a pose. Raises
    MotionInterrupted when it is stopped (the claw stays closed), LinkLost when the camera falls silent.
    """
    if isinstance(zero.offsets, NoOffsets):
        return _unsure(f"the claw cannot be looked at: {zero.offsets.reason}")
    poses = view_poses(context.description, zero)
    if len(poses) < 2:
        return _unsure("the arm cannot show its claw to the camera in two places")
    held, pictures, is_short = _unsure("it was not looked at"), list[HeldPicture](), False
    for number, sent in enumerate(poses):
        context.report(TaskReport("verify", number / len(poses), "looking whether it is held"))
        picture, stops_short = await _picture(context, sent)
        pictures, is_short = [*pictures, picture], is_short or stops_short
        if len(pictures) < 2:
            continue
        arguments = tuple(pictures), zero.offsets, context.description, is_short, thing_width
        held = await context.compute.call(held_in, *arguments)
        if held.verdict is not HeldVerdict.UNSURE:
            break
    return held


async def _picture(context: TaskContext, sent: ArmJoints) -> tuple[HeldPicture, bool]:
    """Take a picture of the closing claw, and hear whether its servo stopped short."""
    states: list[ArmState] = []
    unsubscribe = context.robot.arm.subscribe(states.append)
    try:
        await context.pilot.move_arm(ArmPose(sent.rotation, sent.shoulder, sent.elbow, 0.0))
        frame = await frame_at_rest(context)
    finally:
        unsubscribe()
    return HeldPicture(sent, frame.jpeg), bool(states) and stopped_short(states[-1])


def view_poses(description: RobotDescription, zero: ArmZero) -> tuple[ArmJoints, ...]:
    """Return what to send the servos to hold the claw away and then to show it, at one place after the other;
    none where it cannot be held away, fewer where a place is out of reach.
    """
    arm = zero.seen_arm(description.camera.mount.base_from_camera())
    if arm is None:
        return ()
    away, *shown = (arm.inverse(_before_camera(place, description)).joints for place in (_AWAY, *_SHOWN))
    return () if away is None else (away, *(joints for joints in shown if joints is not None))


def held_away(description: RobotDescription, zero: ArmZero | None) -> ArmJoints | None:
    """Return what to send the servos to hold the claw away, by the robot file where the arm was never seen;
    None where it cannot be.
    """
    seen = None if zero is None else zero.seen_arm(description.camera.mount.base_from_camera())
    arm = description.arm.kinematics() if seen is None else seen
    return arm.inverse(_before_camera(_AWAY, description)).joints


def _before_camera(place: tuple[float, float, float], description: RobotDescription) -> FloatArray:
    mount, (ahead, left, up) = description.camera.mount, place
    return np.array([mount.forward + ahead, mount.left + left, up])


def stopped_short(state: ArmState) -> bool:
    """Tell whether the claw's servo says that it stands open though it was told to close.

    A servo that only repeats what it was sent never says so, and this then tells nothing.
    """
    return not state.is_moving and state.pose.claw - state.target.claw > STOPPED_SHORT


def held_in(
    pictures: Sequence[HeldPicture],
    offsets: ArmOffsets,
    description: RobotDescription,
    is_short: bool = False,
    thing_width: float = 0.0,
) -> Held:
    """Return what pictures of the closed claw say: held away, then shown to the camera (`view_poses`).

    is_short: as `stopped_short` tells. thing_width [m]: as it was seen before, 0 for not known.
    """
    decoded = list[Color]()
    for picture in pictures:
        color = decode_color(picture.jpeg)
        if isinstance(color, BrokenPicture):
            return _unsure(f"a picture cannot be used: {color.reason}")
        decoded.append(color)
    away = decoded[0]
    looks = [
        (
            change_between(shown, steadied(away, shown)),
            _across(by.sent, pictures[0].sent, offsets, description),
        )
        for by, shown in zip(pictures[1:], decoded[1:], strict=True)
    ]
    finger = description.arm.shape().finger_thickness
    widest = description.arm.claw_max / 2.0 + finger
    least = least_opening(thing_width, description)
    width = claw_width(looks, finger + 0.001, finger + least / 2.0, widest)
    opening = max(0.0, 2.0 * (width.half_width - finger))
    if width.disagreement > MOST_DISAGREEMENT and not is_short:
        return replace(_unsure("something else moved beside the claw, or hides it"), opening=opening)
    return _verdict(width.log_odds + (BY_SERVO if is_short else 0.0), opening)


def least_opening(thing_width: float, description: RobotDescription) -> float:
    """Return how far the fingers are apart at least with a thing between them that was seen so wide [m]."""
    return max(LEAST_THING, _LEAST_SHARE * min(thing_width, description.arm.claw_max))


def _verdict(log_odds: float, opening: float) -> Held:
    apart = f"{1000.0 * opening:.0f} mm"
    if log_odds >= SURE:
        return Held(HeldVerdict.HELD, f"something keeps the fingers {apart} apart", opening, log_odds)
    if log_odds <= -SURE:
        return Held(HeldVerdict.NOT_HELD, "the claw closed until its fingers met", opening, log_odds)
    reason = f"the pictures do not tell whether the fingers met or are {apart} apart"
    return Held(HeldVerdict.UNSURE, reason, opening, log_odds)


def _unsure(reason: str) -> Held:
    return Held(HeldVerdict.UNSURE, reason, 0.0, 0.0)


def _across(
    sent: ArmJoints, other: ArmJoints, offsets: ArmOffsets, description: RobotDescription
) -> AcrossClaw:
    """Return the places across the claw sent to `sent`, without those that the arm hides, be it there or
    where it was for the `other` picture.
    """
    shape, camera = description.arm.shape(), description.camera.model()
    reach = description.arm.claw_max / 2.0 + shape.finger_thickness + _BEYOND
    aside = np.arange(-reach, reach, _STEP)
    ends = [(x * shape.finger_beyond, z * shape.hand_radius) for x in _AHEAD for z in _UP]
    points = np.array([(x, y, z) for y in aside for x, z in ends])
    model = SightModel(offsets.arm, offsets.filed_mount)
    in_camera = model.in_camera(offsets.unknowns, sent, points, np.zeros(len(points)))
    seen = camera.project(in_camera)
    capsules = [*_links(sent, offsets, shape), *_links(other, offsets, shape)]
    eye = np.asarray(offsets.base_from_camera.translation)
    hidden = is_hidden(eye, np.asarray(offsets.base_from_camera.apply(in_camera)), capsules)
    pixels = np.where((seen.is_inside & ~hidden)[:, None], seen.pixels, np.nan)
    return AcrossClaw(aside, pixels.reshape(len(aside), len(ends), 2))


def _links(sent: ArmJoints, offsets: ArmOffsets, shape: ArmShape) -> list[Capsule]:
    a, b, c = (float(zero) for zero in offsets.zeros)
    joints = ArmJoints(sent.rotation + a, sent.shoulder + b, sent.elbow + c)
    capsules = arm_capsules(offsets.arm.skeleton(joints), 0.0, shape)
    return [capsule for capsule in capsules if capsule.name == "arm"]
