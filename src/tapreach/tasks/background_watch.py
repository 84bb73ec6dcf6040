"""How the base moved since a key frame, by what stands still in the pictures."""

from dataclasses import replace
from math import radians

from tapreach.estimation.camera_step import camera_step
from tapreach.estimation.rotation_from_background import BackgroundStatus, rotation_from_background
from tapreach.estimation.step_knowledge import NOTHING_SEEN
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.robot_noise import mount_noise, odometry_noise
from tapreach.tasks.sighting import SeenWay, is_apart
from tapreach.vision.background_motion import BackgroundQuality, BackgroundTracker
from tapreach.vision.image_io import Gray

_MOVED_DISTANCE, _MOVED_ANGLE = 0.004, radians(0.3)
"""Below this the wheels know best that nothing moved."""
_THIN = 0.45
"""A new key frame is due when less than this share of the corners is left."""
_SEEN_DISTANCE, _STRAIGHT = 0.025, radians(1.0)
_STILL_PX = 1.0
"""Over a straight way as long as this the nearer things of a room move more than this against the others."""


class BackgroundWatch:
    """Follows the background from a key frame on; `renewed` with a newer one when much of it has gone."""

    def __init__(
        self, picture: Gray, frame_id: int, world_from_base: PlanarPose, description: RobotDescription
    ) -> None:
        self._camera = description.camera.model()
        self._mount = description.camera.mount.base_from_camera()
        self._noise, self._mount_noise = odometry_noise(description), mount_noise(description)
        self.renew(picture, frame_id, world_from_base)

    def renew(self, picture: Gray, frame_id: int, world_from_base: PlanarPose) -> None:
        """Take this frame as the key: ways are counted from it."""
        self._tracker = BackgroundTracker(picture)
        self._key_id, self._key_pose = frame_id, world_from_base
        self._marked_at = world_from_base

    @property
    def is_thin(self) -> bool:
        """True when little is left in the picture of what the key frame showed."""
        return len(self._tracker) < _THIN * self._tracker.begun_with

    def follow(self, picture: Gray) -> None:
        """Carry on to the next picture."""
        self._tracker.follow(picture)

    def way_to(self, world_from_base: PlanarPose) -> SeenWay | None:
        """Return what is seen of the way from the key frame to the newest picture; None where the base has
        hardly moved.

        world_from_base: where the wheels say the newest picture was taken.
        """
        if not is_apart(self._key_pose, world_from_base, _MOVED_DISTANCE, _MOVED_ANGLE):
            return None
        if self._stands_still(world_from_base):
            return SeenWay(self._key_id, replace(NOTHING_SEEN, has_slipped=True), stands_still=True)
        pairs = self._tracker.pairs()
        if pairs.quality is BackgroundQuality.POOR:
            return SeenWay(self._key_id, NOTHING_SEEN, pairs.reason)
        step = camera_step(
            self._key_pose.between(world_from_base), self._noise, self._mount, self._mount_noise
        )
        found = rotation_from_background(pairs.first, pairs.now, self._camera, step)
        reason = found.reason if found.status is BackgroundStatus.POOR else ""
        return SeenWay(self._key_id, found.knowledge, reason)

    def _stands_still(self, world_from_base: PlanarPose) -> bool:
        """Tell whether nothing in the picture has come nearer while the wheels made a straight way.

        What pushes in vain may rear up, which moves the picture as a whole.
        """
        way, self._marked_at = self._marked_at.between(world_from_base), world_from_base
        parted = self._tracker.parted_px()
        self._tracker.mark()
        is_straight_way = abs(way.x) > _SEEN_DISTANCE and abs(way.heading) < _STRAIGHT
        return is_straight_way and parted is not None and parted < _STILL_PX
