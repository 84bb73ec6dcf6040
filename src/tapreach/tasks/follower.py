"""Follows one tapped place: through the stored frames up to now, then live, while the robot moves or
stands.
"""

import asyncio
from collections.abc import Awaitable, Callable, Coroutine, Iterable, Sequence
from dataclasses import replace
from itertools import takewhile
from math import radians
from typing import Any, TypeVar

import numpy as np

from tapreach.errors import PoseExpired, PoseNotYetKnown, TapreachError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel, require_inside
from tapreach.robot.clock import MS, SECOND
from tapreach.robot.messages import Frame
from tapreach.tasks import following
from tapreach.tasks.frame_pose import pose_at
from tapreach.tasks.sighting import Passed, Sighting, is_apart, sigma_of_timing
from tapreach.tasks.target_watch import Shot
from tapreach.tasks.task import Tap, TaskContext

T = TypeVar("T")

_RATE_OVER_NS = 40 * MS
_SKIP_DISTANCE, _SKIP_ANGLE = 0.02, radians(2.0)
_LEAST_KEPT = 4
_NEWEST_PASSED = 3
"""Of what was passed unseen: so many agree on whether the wheels slip."""
LATEST_NS = SECOND
"""Pictures later than this are taken for pictures of now."""


class TargetLost(TapreachError):
    """The followed place cannot be seen any more, and there is not enough for a position."""


class Follower:
    """Sightings of one tapped place, newest last in `sightings`; of those between which little moved one is
    kept, beside the newest two.

    key: under which the tracker is kept where the computing is done. uses_background: False leaves all turns
    to the wheels.
    """

    def __init__(self, context: TaskContext, tap: Tap, key: int, uses_background: bool = True) -> None:
        self._context = context
        self._tap = tap
        self._key = key
        self._uses_background = uses_background
        self.frame_id = tap.frame_id
        """The newest frame that was looked at."""
        self.sightings: list[Sighting] = []
        self._passed: list[Passed] = []
        self.weakness = ""
        self.loss = ""
        """Why it is not seen in the newest frame; '' while it is."""
        self.doubt = ""
        """Why the last check could not confirm what was followed; '' where nothing speaks against it."""
        self.point_in_world: FloatArray | None = None
        """Where the target is (3,) [m], once somebody knows it: makes for better guesses."""

    @property
    def key(self) -> int:
        """Under which the tracker is kept where the computing is done."""
        return self._key

    @property
    def last(self) -> Sighting:
        """The newest sighting."""
        return self.sightings[-1]

    def way_since(self, frame_id: int) -> tuple[Sighting | Passed, ...]:
        """Return what the way since a sighting was seen by, from the last key before it on; empty where that
        sighting is not kept any more.
        """
        ids = [each.frame_id for each in self.sightings]
        if frame_id not in ids:
            return ()
        keys = [i for i, each in enumerate(self.sightings[: ids.index(frame_id) + 1]) if each.is_key]
        return (*self.sightings[keys[-1] if keys else ids.index(frame_id) :], *self._passed)

    async def open(self) -> Sighting:
        """Look up the tapped frame and begin. Raises FrameError, PoseError, InputError, PictureBroken."""
        frame = self._context.frames.get(self._tap.frame_id)
        place = require_inside(Pixel(self._tap.u, self._tap.v), frame.size)
        shot = await self._shot(frame)
        sighting, self.weakness = await self._context.compute.call(
            following.open_track, self._key, shot, place, self._context.description, self._uses_background
        )
        self.sightings.append(sighting)
        return self.last

    async def close(self) -> None:
        """Forget the tracker."""
        await self._context.compute.call(following.close_track, self._key)

    async def catch_up(self) -> None:
        """Follow through the stored frames up to the newest, leaving out those between which little moved."""
        while frames := self._worth_following(self._context.frames.since(self.frame_id)):
            for frame in frames:
                await self._follow(frame)

    async def during(self, motion: Coroutine[Any, Any, T], after_each: Callable[[], Awaitable[None]]) -> T:
        """Follow live frames until `motion` has ended, calling `after_each` of them; return the motion's
        result.

        When following fails, or this is cancelled, the motion is cancelled and seen to end first.
        """
        moving = asyncio.create_task(motion)
        try:
            while not moving.done():
                await self._follow_next(moving)
                await after_each()
            return moving.result()
        finally:
            moving.cancel()
            # Gathering takes note of its error too, when the motion ended before this was cancelled.
            await asyncio.gather(moving, return_exceptions=True)

    async def look(self, frames: int = 4) -> Sighting | None:
        """Watch `frames` frames at rest; append one sighting made of them, or return None when not seen.

        Frames at rest share their errors, so that they count as one.
        """
        seen: list[Sighting] = []
        await self._follow_what_is_on_its_way()
        for left in reversed(range(frames)):
            frame = await self._context.next_frame(self.frame_id)
            sighting = await self._follow(frame, is_stop=left == 0)
            if sighting is not None:
                self.sightings.pop()
                seen.append(sighting)
        if not seen:
            return None
        u, v = np.mean([(each.pixel.u, each.pixel.v) for each in seen], axis=0)
        sigma = float(np.mean([each.sigma for each in seen]))
        self.sightings.append(replace(seen[-1], pixel=Pixel(float(u), float(v)), sigma=sigma))
        return self.last

    async def check(self) -> None:
        """At rest: ask whether what was followed is what was tapped, and go on with what is believed of it.

        Sightings that slid are measured again or gone; a place that was lost may be found again.
        """
        checked = await self._context.compute.call(following.check, self._key)
        followed, self.sightings = self.sightings, list(checked.sightings)
        self.doubt = checked.doubt
        if self.last.frame_id == self.frame_id:
            self.loss = ""
            self._passed.clear()
        else:
            self._pass_by(followed)

    def _pass_by(self, followed: Sequence[Sighting]) -> None:
        """Keep what is known of the way since the last sighting, where later ones were not of the target."""
        gone = [
            Passed(each.frame_id, each.world_from_base, each.way, each.is_key)
            for each in followed
            if each.way is not None
        ]
        ways = sorted({each.frame_id: each for each in (*gone, *self._passed)}.items())
        self._passed.clear()
        for frame_id, passed in ways:
            if frame_id > self.last.frame_id:
                self._pass(passed)

    async def _follow_what_is_on_its_way(self) -> None:
        """Follow the frames that were taken before now, until the next one is from now on."""
        context, now_ns = self._context, self._context.clock.now_ns()
        period_ns = round(SECOND / context.description.camera.rate_hz)
        newest = context.frames.newest
        while newest is not None and context.camera_delay.taken_ns(newest.captured_ns) < now_ns - period_ns:
            if context.clock.now_ns() - now_ns > LATEST_NS:
                return
            newest = await context.next_frame(self.frame_id)
            await self._follow(newest)

    async def _follow_next(self, moving: asyncio.Task[Any]) -> None:
        waiting = asyncio.ensure_future(self._context.next_frame(self.frame_id))
        try:
            await asyncio.wait({waiting, moving}, return_when=asyncio.FIRST_COMPLETED)
            if waiting.done():
                await self._follow(waiting.result())
        finally:
            waiting.cancel()

    async def _follow(self, frame: Frame, is_stop: bool = False) -> Sighting | None:
        self.frame_id = frame.frame_id
        shot = await self._shot(frame)
        followed = await self._context.compute.call(
            following.follow, self._key, shot, self.point_in_world, is_stop
        )
        self.loss = followed.loss
        if followed.passed is not None:
            self._pass(followed.passed)
        if followed.sighting is not None:
            self._passed.clear()
            self._take(followed.sighting)
        return followed.sighting

    def _pass(self, passed: Passed) -> None:
        """Keep it, and of those since the last key the newest; of keys without a way between, the last."""
        since_key = list(takewhile(lambda each: not each.is_key, reversed(self._passed)))
        if len(since_key) >= _NEWEST_PASSED:
            del self._passed[-len(since_key)]
        if passed.way.reason and self._passed and self._passed[-1].is_key:
            self._passed.pop()
        self._passed.append(passed)

    def _take(self, sighting: Sighting) -> None:
        self.sightings.append(sighting)
        if len(self.sightings) > _LEAST_KEPT and self._says_little(-3):
            del self.sightings[-3]

    def _says_little(self, index: int) -> bool:
        kept, this = self.sightings[index - 1], self.sightings[index]
        if this.is_key or this.way is not None:
            return False
        return not is_apart(kept.world_from_base, this.world_from_base, _SKIP_DISTANCE, _SKIP_ANGLE)

    async def _shot(self, frame: Frame) -> Shot:
        world_from_base = await pose_at(self._context, frame.captured_ns)
        return Shot(
            frame.frame_id, frame.captured_ns, frame.jpeg, world_from_base, self._moved_px(frame.captured_ns)
        )

    def _moved_px(self, captured_ns: int) -> float:
        poses, delay = self._context.poses, self._context.camera_delay
        camera = self._context.description.camera
        taken_ns = delay.taken_ns(captured_ns)
        try:
            step = poses.at(taken_ns - _RATE_OVER_NS).between(poses.at(taken_ns))
        except PoseExpired:
            return 0.0
        timing_sigma = delay.timing_sigma(camera.timing_sigma_ms)
        return sigma_of_timing(step, _RATE_OVER_NS / SECOND, camera, timing_sigma)

    def _worth_following(self, frames: list[Frame]) -> list[Frame]:
        """Return the frames between which the robot moved enough to matter, the newest one, and
        one a second.
        """
        kept: list[Frame] = []
        for frame in frames:
            if frame is frames[-1] or self._moved_since(kept[-1] if kept else None, frame):
                kept.append(frame)
        return kept

    def _moved_since(self, kept: Frame | None, frame: Frame) -> bool:
        before_ns = kept.captured_ns if kept is not None else self.last.captured_ns
        if frame.captured_ns - before_ns >= SECOND:
            return True
        poses, delay = self._context.poses, self._context.camera_delay
        try:
            first, second = (poses.at(delay.taken_ns(each)) for each in (before_ns, frame.captured_ns))
        except (PoseExpired, PoseNotYetKnown):
            return True
        return is_apart(first, second, _SKIP_DISTANCE, _SKIP_ANGLE)


def thinned(
    stops: Iterable[Sighting], others: Iterable[Sighting], distance: float, angle: float
) -> list[Sighting]:
    """Return all `stops`, the keys among the `others`, and those of them whose pose lies apart from all
    kept, in the order of time.

    Those whose way the background has seen come before the rest, the newest first: it saw the longest way.
    """
    kept = list(stops)
    for sighting in sorted(others, key=lambda each: (not each.is_key, each.way is None, -each.captured_ns)):
        here = sighting.world_from_base
        if sighting.is_key or all(is_apart(each.world_from_base, here, distance, angle) for each in kept):
            kept.append(sighting)
    return sorted(kept, key=lambda each: each.captured_ns)
