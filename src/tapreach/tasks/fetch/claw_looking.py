"""From pictures of the open and the closed claw to the zeros of the servos."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

from tapreach.estimation.arm_offsets import ArmOffsets, NoOffsets, estimate_arm_offsets
from tapreach.estimation.claw_sight import ArmNoise, ClawPlace, ClawView, SightModel
from tapreach.estimation.motion_prior import MountNoise
from tapreach.geometry.arm_clearance import ArmShape
from tapreach.geometry.arm_kinematics import ArmJoints
from tapreach.geometry.finite import FloatArray
from tapreach.robot.config import RobotDescription
from tapreach.tasks.fetch.claw_outline import NO_ERRORS, FingerEnd, claw_parts, finger_ends
from tapreach.vision.claw_motion import Change, NotSeen, SeenPart, change_between, seen_parts
from tapreach.vision.image_io import BrokenPicture, decode_color

ZERO_SIGMA_DEG = 3.0
"""A servo's horn sits on its teeth by so much off, one sigma."""
PLAY_SIGMA_DEG = 0.22
"""Play of the gears and give under load, from pose to pose."""
OPENING_SIGMA = 0.001
"""Of the claw's opening [m]."""
MOUNT_SIGMA = MountNoise(0.008, radians(1.5))
"""A camera that was knocked since its mount was measured. The robot's file is for a camera in its place."""
_FIRST_REACH, _LATER_REACH = 140, 30
"""How far from where it should be the claw is looked for [px], before and after it was first seen."""
_LEANING_DEG = (0.0, -2.5, 2.5, -5.0, 5.0)
_ROUNDS = 2


@dataclass(frozen=True, slots=True)
class ClawPictures:
    """Two pictures (JPEG) with base and arm at rest, servos sent to `sent`, the claw to `wide` and `narrow`
    [m].
    """

    sent: ArmJoints
    wide: float
    narrow: float
    opened: bytes
    closed: bytes

    def ends(self, shape: ArmShape) -> dict[str, FingerEnd]:
        """Return the ends of the fingers in both pictures."""
        return finger_ends(shape, self.wide, self.narrow)


@dataclass(frozen=True, eq=False)
class ClawReading:
    """What the pictures say: offsets or why not, and for each pair of pictures the parts seen, or why not."""

    offsets: ArmOffsets | NoOffsets
    seen: tuple[tuple[SeenPart, ...] | NotSeen, ...]

    @property
    def views(self) -> int:
        """Return in how many pairs the claw was seen."""
        return sum(not isinstance(parts, NotSeen) for parts in self.seen)


def arm_noise() -> ArmNoise:
    """Return how far an arm of hobby servos may be off before it was looked at."""
    return ArmNoise(radians(ZERO_SIGMA_DEG), radians(PLAY_SIGMA_DEG), OPENING_SIGMA, MOUNT_SIGMA)


def read_claw(pictures: Sequence[ClawPictures], description: RobotDescription) -> ClawReading:
    """Return what pictures of the claw in several poses say of the servos' zeros.

    Each is looked at knowing what those before it said, then all again: the outline that is looked for
    becomes the true one.
    """
    changes = [_change(pair) for pair in pictures]
    seen: list[tuple[SeenPart, ...] | NotSeen] = []
    offsets: ArmOffsets | NoOffsets = NoOffsets("the claw was not looked at")
    for number in range(len(pictures)):
        seen.append(_looked(pictures[number], changes[number], offsets, description))
        offsets = _estimated(pictures[: number + 1], seen, description)
    for _ in range(_ROUNDS):
        if isinstance(offsets, NoOffsets):
            break
        seen = [_looked(*each, offsets, description) for each in zip(pictures, changes, strict=True)]
        offsets = _estimated(pictures, seen, description)
    return ClawReading(offsets, tuple(seen))


def _change(pair: ClawPictures) -> Change | NotSeen:
    opened, closed = decode_color(pair.opened), decode_color(pair.closed)
    if isinstance(opened, BrokenPicture):
        return NotSeen(opened.reason)
    if isinstance(closed, BrokenPicture):
        return NotSeen(closed.reason)
    return change_between(opened, closed)


def _looked(
    pair: ClawPictures,
    change: Change | NotSeen,
    offsets: ArmOffsets | NoOffsets,
    description: RobotDescription,
) -> tuple[SeenPart, ...] | NotSeen:
    if isinstance(change, NotSeen):
        return change
    if isinstance(offsets, ArmOffsets):
        return _found(pair, change, offsets.unknowns, _LATER_REACH, description)
    # Raised or lowered the claw looks otherwise: outlines are tried for several heights, then moved about.
    tries = [_found(pair, change, _leaning(angle), _FIRST_REACH, description) for angle in _LEANING_DEG]
    return max(tries, key=_agreement)


def _found(
    pair: ClawPictures, change: Change, unknowns: FloatArray, reach: int, description: RobotDescription
) -> tuple[SeenPart, ...] | NotSeen:
    model = SightModel(description.arm.kinematics(), description.camera.mount.base_from_camera())
    shape, camera = description.arm.shape(), description.camera.model()
    parts = claw_parts(model, unknowns, camera, pair.sent, list(pair.ends(shape).values()), shape)
    if not parts:
        return NotSeen("the claw is not before the camera")
    found = seen_parts(change, parts, reach)
    if isinstance(found, NotSeen):
        return found
    return tuple(part for part in found if isinstance(part, SeenPart))


def _leaning(angle_deg: float) -> FloatArray:
    """Return the unknowns (10,) of an arm whose shoulder and elbow both lean forward by so much."""
    unknowns = NO_ERRORS.copy()
    unknowns[1:3] = radians(angle_deg)
    return unknowns


def _agreement(parts: tuple[SeenPart, ...] | NotSeen) -> float:
    return 0.0 if isinstance(parts, NotSeen) else sum(part.inside - part.around for part in parts)


def _estimated(
    pictures: Sequence[ClawPictures],
    seen: Sequence[tuple[SeenPart, ...] | NotSeen],
    description: RobotDescription,
) -> ArmOffsets | NoOffsets:
    shape = description.arm.shape()
    views = [
        ClawView(pair.sent, tuple(_place(part, pair.ends(shape)[part.name]) for part in parts))
        for pair, parts in zip(pictures, seen, strict=True)
        if not isinstance(parts, NotSeen)
    ]
    if not views:
        reasons = [parts.reason for parts in seen if isinstance(parts, NotSeen)]
        return NoOffsets(reasons[-1] if reasons else "the claw was not looked at")
    return estimate_arm_offsets(
        views,
        description.arm.kinematics(),
        description.camera.model(),
        description.camera.mount.base_from_camera(),
        arm_noise(),
    )


def _place(part: SeenPart, end: FingerEnd) -> ClawPlace:
    return ClawPlace(end.mark, end.by_opening, part.mark, part.sigma)
