"""Follows a tapped place and the background behind it, frame by frame; lives where the computing is done."""

from dataclasses import dataclass, replace
from math import hypot, radians

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.robot.config import RobotDescription
from tapreach.tasks.background_watch import BackgroundWatch
from tapreach.tasks.depth_check import Checked
from tapreach.tasks.depth_views import DepthViews
from tapreach.tasks.distance_range import DistanceRange
from tapreach.tasks.guessing import guesses_for
from tapreach.tasks.sighting import TAP_SIGMA, Passed, SeenWay, Sighting, is_apart, ray_of
from tapreach.vision.image_io import Gray
from tapreach.vision.track import Guess, TrackStatus
from tapreach.vision.tracker import PatchTracker

_WAY_DISTANCE, _WAY_ANGLE = 0.03, radians(3.0)
"""While the robot moves its way is measured this often."""
_ABOUT = 1.0, 0.85, 1.18
"""A known distance may be so much wrong."""


@dataclass(frozen=True, slots=True)
class Shot:
    """A frame and how the robot moved at it.

    moved_px: one sigma [px] that the frame's time adds to what is seen in it, from the robot's speed; 0 at
    rest.
    """

    frame_id: int
    captured_ns: int
    jpeg: bytes
    world_from_base: PlanarPose
    moved_px: float


@dataclass(frozen=True, slots=True)
class Followed:
    """What a frame showed. sighting: None when the place is not seen, and `loss` then says why; passed: the
    way to there, where it was measured all the same.
    """

    sighting: Sighting | None
    loss: str
    passed: Passed | None = None


class TargetWatch:
    """One tapped place. The first picture is the tapped one.

    uses_background: False leaves the way to the wheels. Raises InputError for a pixel outside the picture.
    """

    def __init__(
        self, picture: Gray, shot: Shot, place: Pixel, description: RobotDescription, uses_background: bool
    ) -> None:
        self._tracker = PatchTracker(picture, place.u, place.v)
        self._size = ImageSize(picture.shape[1], picture.shape[0])
        self._description = description
        self._background = (
            BackgroundWatch(picture, shot.frame_id, shot.world_from_base, description)
            if uses_background
            else None
        )
        self._measured_at = shot.world_from_base
        sigma = hypot(TAP_SIGMA, shot.moved_px)
        self.last = Sighting(
            shot.frame_id, shot.captured_ns, place, sigma, 1.0, shot.world_from_base, is_key=True
        )
        """The newest sighting."""
        self._distances = DistanceRange(self.last, description)
        self._views = DepthViews(picture, self.last, description)
        self._picture = picture

    @property
    def weakness(self) -> str:
        """Why the place will be hard to follow; '' when it will not."""
        return self._tracker.weakness

    def follow(self, picture: Gray, shot: Shot, point_in_world: FloatArray | None, is_stop: bool) -> Followed:
        """Return what the next picture shows.

        point_in_world: (3,) where the target is, as far as known. is_stop: measure the way, and take this
        frame as the next key. Raises InputError for a picture of another size.
        """
        track = self._tracker.follow(picture, self._guesses(shot, point_in_world))
        if self._background is not None:
            self._background.follow(picture)
        self._picture = picture
        loss = track.reason if track.status is TrackStatus.LOST else ""
        is_seen = track.pixel is not None and track.pixel.is_inside(self._size)
        pixel = track.pixel if is_seen and track.pixel is not None else self.last.pixel
        sigma = hypot(track.sigma, shot.moved_px)
        there = Sighting(shot.frame_id, shot.captured_ns, pixel, sigma, track.scale, shot.world_from_base)
        there = self._with_way(there, picture, is_stop, is_seen)
        self._views.keep(there, picture, shot.moved_px, is_seen, is_stop)
        if not is_seen:
            return Followed(None, loss, _passed(there))
        self._distances.note(there)
        self.last = there
        return Followed(there, loss)

    def check(self) -> Checked:
        """Return what is to be believed of the sightings so far by the tapped patch itself; go on from it.

        For a robot at rest: it takes longer than a frame may.
        """
        newest, was_seen = self._views.newest, self._views.newest.frame_id == self.last.frame_id
        checked = self._views.check()
        self.last = checked.sightings[-1]
        if checked.newest is None or checked.layer is None:
            return checked
        if not was_seen or self.last.pixel != newest.pixel:
            self._tracker.resume(self._picture, checked.newest, checked.layer)
        self._distances = DistanceRange(checked.sightings[0], self._description)
        for sighting in checked.sightings[1:]:
            self._distances.note(sighting)
        return checked

    def _guesses(self, shot: Shot, point_in_world: FloatArray | None) -> tuple[Guess, ...]:
        """Return where it may be: by its point as far as known, else by what its way leaves possible."""
        if point_in_world is None:
            return self._distances.guesses(self.last, shot.world_from_base)
        distance = self._distance_to(point_in_world)
        supposed = [distance * factor for factor in _ABOUT]
        return guesses_for(self.last, shot.world_from_base, self._description, supposed)

    def _distance_to(self, point_in_world: FloatArray) -> float:
        return float(np.linalg.norm(point_in_world - ray_of(self.last, self._description).origin))

    def _with_way(self, seen: Sighting, picture: Gray, is_stop: bool, is_seen: bool) -> Sighting:
        """Return the sighting with what the background says of it, which may make it the next key: a stop if
        the place `is_seen` there, and any where little is left of the last one, or unseen all is.
        """
        if self._background is None:
            return seen
        is_due = is_apart(self._measured_at, seen.world_from_base, _WAY_DISTANCE, _WAY_ANGLE)
        if not (is_stop or is_due or self._background.is_thin):
            return seen
        way: SeenWay | None = self._background.way_to(seen.world_from_base)
        self._measured_at = seen.world_from_base
        is_useless = not is_seen and way is not None and bool(way.reason)
        is_key = self._background.is_thin or is_useless or (is_stop and is_seen)
        if is_key:
            self._background.renew(picture, seen.frame_id, seen.world_from_base)
        return replace(seen, way=way, is_key=is_key)


def _passed(seen: Sighting) -> Passed | None:
    """Return what is left of a sighting without its target."""
    if seen.way is None:
        return None
    return Passed(seen.frame_id, seen.world_from_base, seen.way, seen.is_key)
