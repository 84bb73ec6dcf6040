"""Pictures taken since the thing was last seen: where the base was then, by the wheels.

On a way round the thing leaves the picture, and what stands there comes into it.
"""

from dataclasses import dataclass
from typing import Protocol

from tapreach.errors import PoseExpired, PoseNotYetKnown
from tapreach.estimation.pose_history import PoseHistory
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.frame_store import FrameStore
from tapreach.robot.messages import Frame
from tapreach.tasks.delay_kept import DelayKept
from tapreach.tasks.sighting import Sighting, is_apart

_APART_WAY, _APART_ANGLE = 0.03, 0.1
_MOST = 20
"""Pictures nearer to each other [m, rad] show the same; so many of them are enough."""


class PicturesKept(Protocol):
    """What of a task's context tells where pictures were taken."""

    @property
    def frames(self) -> FrameStore:
        """The newest pictures."""
        ...

    @property
    def poses(self) -> PoseHistory:
        """Where the base was, by the wheels."""
        ...

    @property
    def camera_delay(self) -> DelayKept:
        """How late pictures are."""
        ...


@dataclass(frozen=True)
class LaterPicture:
    """A picture in which nothing is followed. pixel: None, unlike that of a sighting."""

    frame_id: int
    world_from_base: PlanarPose
    pixel: None = None


def later_pictures(context: PicturesKept, last: Sighting) -> list[LaterPicture]:
    """Return the newest kept pictures taken after the last sighting, apart from it and from each other, in
    order; those of which nobody knows where they were taken are left out.
    """
    found: list[LaterPicture] = []
    for frame in reversed(context.frames.since(last.frame_id)):
        pose = _pose_at(context, frame)
        if pose is None or not _differs(last.world_from_base, pose):
            continue
        if not found or _differs(found[-1].world_from_base, pose):
            found.append(LaterPicture(frame.frame_id, pose))
        if len(found) == _MOST:
            break
    return found[::-1]


def _pose_at(context: PicturesKept, frame: Frame) -> PlanarPose | None:
    try:
        return context.poses.at(context.camera_delay.taken_ns(frame.captured_ns))
    except (PoseExpired, PoseNotYetKnown):
        return None


def _differs(one: PlanarPose, other: PlanarPose) -> bool:
    return is_apart(one, other, _APART_WAY, _APART_ANGLE)
