"""One run of locating: move, follow the place, estimate, until it is known well enough or nothing helps."""

import asyncio
from collections.abc import Coroutine
from dataclasses import replace
from math import radians
from typing import Any

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.ray import Ray
from tapreach.robot.clock import MS
from tapreach.tasks.candidate_moves import SHORTEST_ADVANCE
from tapreach.tasks.estimating import HeadingSource, LocatedPoint, estimate
from tapreach.tasks.extent import extent_of_thing
from tapreach.tasks.fetch.obstacle import Obstacle
from tapreach.tasks.fetch.size import size_of
from tapreach.tasks.fetch.thing import NoSize, ThingSize
from tapreach.tasks.fixed_move import fixed_step
from tapreach.tasks.follower import Follower, TargetLost, thinned
from tapreach.tasks.free_way import way_behind
from tapreach.tasks.going_back import LostSide, way_back
from tapreach.tasks.known_place import KnownPlace
from tapreach.tasks.locate_end import End, closing_reason, closing_sentence, has_helped, is_worthwhile
from tapreach.tasks.locate_watch import (
    BLOCKED,
    HIDDEN,
    SLIPPING,
    MoveWatch,
    is_accurate,
    is_blocked,
    is_hardly_known,
)
from tapreach.tasks.move_choice import Choice, Room, planned_move
from tapreach.tasks.online import Seen, online_picture
from tapreach.tasks.planned_move import PlannedMove
from tapreach.tasks.sighting import Passed, Sighting, ray_of
from tapreach.tasks.supposed_distance import supposed_distances
from tapreach.tasks.target import Target
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import TaskContext, TaskReport

MOST_MOVES = 5
MOST_DRIVEN, LONGEST_ADVANCE = 0.8, 0.5
"""Way [m] that locating may drive in all, and in one move."""
LOOK_FRAMES = 3
_RENEW_AT_LEAST_NS = 90 * MS
"""On a machine that cannot estimate with every frame that it follows it does so as often as this."""
_APART_DISTANCE, _APART_ANGLE = 0.05, radians(6.0)


class Locating:
    """One run of the task, on a tap that `aimed` has seen; a task that goes on with the thing keeps it.

    is_fixed: makes the paper's move, whatever it brings, instead of chosen ones.
    """

    def __init__(
        self,
        context: TaskContext,
        follower: Follower,
        report: TargetReport,
        accuracy: float,
        is_fixed: bool = False,
    ) -> None:
        self._context = context
        self._follower = follower
        self._report = report
        self._accuracy = accuracy
        self._is_fixed = is_fixed
        self.keep_clear: tuple[Obstacle, ...] = ()
        """What else is known to stand there, in the world: no chosen move turns or drives into it."""
        self._known: KnownPlace | None = None
        self._stops: list[Sighting] = []
        self._estimate: LocatedPoint | None = None
        self._driven = 0.0
        self._lost_sides: list[LostSide] = []
        self._renewed_ns = 0
        self._seen_ns = 0
        self._enough = asyncio.Event()
        self._cut_short = ""
        """Why the newest move was ended before it was done; '' when it was not."""
        self.size: ThingSize | NoSize | None = None
        """How large the thing was measured to be at the end of `run`; None before, and without a position."""

    @property
    def estimate(self) -> LocatedPoint | None:
        """What is known by now; None before there are two sightings."""
        return self._estimate

    @property
    def way_since_seen(self) -> tuple[Sighting | Passed, ...]:
        """By what the way since the newest sighting of the estimate was seen; see at_present."""
        newest = self._estimate.sightings[-1] if self._estimate is not None else None
        return () if newest is None else self._follower.way_since(newest.frame_id)

    @property
    def follower(self) -> Follower:
        """What follows the tapped place."""
        return self._follower

    async def run(self) -> str:
        """Locate and return the closing sentence. Raises as LocateTask.run."""
        self._say("look", 0.0, "looking at the tapped place")
        await self.begin()
        end = await (self._make_fixed() if self._is_fixed else self._refine())
        await self._renew(with_advice=end not in (End.REACHED, End.LOST))
        await self._measure()
        return self._conclusion(end)

    async def begin(self) -> None:
        """Begin to follow, without a move. Raises as LocateTask.run."""
        self._stops.append(await self._follower.open())
        self._show()
        await self._follower.catch_up()
        await self._renew_if_known()

    async def recall(self, known: KnownPlace | None) -> None:
        """Make use of where the tapped place was by an earlier look, from now on; None: of nothing."""
        self._known = known
        if self._stops:
            await self._renew_if_known()

    async def _renew_if_known(self) -> None:
        if self._known is not None:
            await self._renew(with_advice=False)

    async def drive(self, motion: Coroutine[Any, Any, object]) -> str:
        """Go on following and estimating while `motion` is carried out, and look once it has ended; end it
        where something blocks the robot, and return that, '' otherwise.

        Raises TargetLost when the place is not seen any more and not known, MotionInterrupted, LinkLost.
        """
        begun = self._follower.frame_id
        self._enough.clear()
        await self._follower.during(self._until_enough(motion), lambda: self._keep_up_while_free(begun))
        if self._enough.is_set():
            await self._context.pilot.move(PlanarStep(0.0, 0.0))
        await self._look()
        return BLOCKED if self._enough.is_set() else ""

    async def _keep_up_while_free(self, begun: int) -> None:
        await self._keep_up()
        if is_blocked([each for each in self._follower.sightings if each.frame_id > begun]):
            self._enough.set()

    async def _keep_up(self) -> None:
        """Renew the picture with the frame just followed; when the machine is behind following is first."""
        newest = self._context.frames.newest
        is_behind = newest is not None and newest.frame_id > self._follower.frame_id
        now_ns = self._context.clock.now_ns()
        if is_behind and now_ns - self._renewed_ns < _RENEW_AT_LEAST_NS:
            return
        self._renewed_ns = now_ns
        sightings, follower = self._sightings(), self._follower
        seen = Seen(sightings, follower.last, follower.loss, self._here, self._known, self.way_since_seen)
        picture = await self._context.compute.call(online_picture, seen, self._report)
        if picture.estimate is not None:
            self._estimate = picture.estimate
        if picture.target.point_in_world is not None:
            self._follower.point_in_world = picture.target.point_in_world
        self._context.show_target(picture.target)

    async def _refine(self) -> End:
        """Move and look until there is a reason to end it."""
        if is_accurate(self._estimate, self._accuracy):
            return End.REACHED
        for move in range(MOST_MOVES):
            choice = await self._choose()
            if choice is None:
                return End.NO_MOVE
            before = self._estimate
            if not is_worthwhile(choice, before):
                return End.NO_GAIN
            planned = PlannedMove.of(choice, self._here)
            progress = 0.1 + 0.8 * move / MOST_MOVES
            self._say("move", progress, planned.in_words)
            await self._make(planned, progress)
            if is_accurate(self._estimate, self._accuracy):
                return End.REACHED
            if self._follower.loss:
                return End.LOST
            if self._cut_short in (BLOCKED, SLIPPING):
                return End.OBSTRUCTED
            if not self._cut_short and not has_helped(before, self._estimate):
                return End.NO_GAIN
            if self._way_left < SHORTEST_ADVANCE:
                break
        return End.WAY_USED_UP

    async def _make_fixed(self) -> End:
        """Make the paper's move to its end and look."""
        step = fixed_step(self._stops[0], self._context.description)
        self._say("move", 0.1, "making the paper's move")
        self._driven += step.advance
        await self.drive(self._context.pilot.move(step, self._context.description.arm.standard.pose()))
        if is_accurate(self._estimate, self._accuracy):
            return End.REACHED
        return End.LOST if self._follower.loss else End.WAY_USED_UP

    async def _make(self, planned: PlannedMove, progress: float) -> None:
        """Make the move as far as it has a purpose, once the arm is out of the picture; look."""
        arm = self._context.description.arm.standard.pose()
        watch = self._watch_over(planned)
        self._context.show_move(planned)
        self._enough.clear()
        self._cut_short = ""
        self._seen_ns = self._context.clock.now_ns()
        try:
            await self._follower.during(
                self._until_enough(self._context.pilot.move(planned.step, arm)), lambda: self._refresh(watch)
            )
        finally:
            self._context.show_move(None)
        if self._enough.is_set():
            await self._context.pilot.move(PlanarStep(0.0, 0.0))
        await self._take_stop()
        if (side := self._side_to_leave()) is not None:
            self._lost_sides.append(side)
            self._say("move", progress, f"{HIDDEN}: going back, to look from the other side")
            await self._go_back(planned)
        else:
            way = planned.start.between(self._here)
            self._driven += (way.x**2 + way.y**2) ** 0.5
        self._require_known()

    def _side_to_leave(self) -> LostSide | None:
        """Return the side to which a move has lost what is hardly known, once for each; else None."""
        if not self._follower.loss or not is_hardly_known(self._estimate) or len(self._lost_sides) > 1:
            return None
        seen_from, description = self._follower.last.world_from_base, self._context.description
        return LostSide.between(self._first_ray, seen_from, self._here, description)

    async def _go_back(self, planned: PlannedMove) -> None:
        """Undo a move that has lost the place, and look from where it began, where it was seen."""
        self._cut_short = HIDDEN
        for step in way_back(planned.start, self._here):
            await self._follower.during(self._context.pilot.move(step), self._keep_up)
        await self._take_stop()

    async def _until_enough(self, motion: Coroutine[Any, Any, object]) -> None:
        """Carry out a motion, or end it at once when it has no more purpose."""
        moving, enough = asyncio.ensure_future(motion), asyncio.ensure_future(self._enough.wait())
        try:
            await asyncio.wait({moving, enough}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            enough.cancel()
            moving.cancel()
            await asyncio.gather(moving, enough, return_exceptions=True)
        if not moving.cancelled():
            moving.result()

    async def _refresh(self, watch: MoveWatch) -> None:
        """Renew what is known, and see whether the move has a purpose still."""
        now_ns = self._context.clock.now_ns()
        if not self._follower.loss:
            self._seen_ns = now_ns
        await self._keep_up()
        reason = watch.reason_to_stop(self._follower.sightings, self._estimate, now_ns - self._seen_ns)
        if reason:
            self._cut_short = reason
            self._enough.set()

    def _watch_over(self, planned: PlannedMove) -> MoveWatch:
        ray = self._first_ray
        nearest = self._supposed_distances(None)[0]
        is_forward = planned.step.advance > 0.0
        return MoveWatch(self._context.description, self._accuracy, ray, nearest, is_forward)

    async def _look(self) -> None:
        """Take a sighting at rest and renew the estimate. Raises TargetLost when it is not seen
        and not known.
        """
        await self._take_stop()
        self._require_known()

    async def _take_stop(self) -> None:
        sighting = await self._follower.look(LOOK_FRAMES)
        if sighting is not None:
            self._stops.append(sighting)
        await self._check()
        await self._renew(with_advice=False)

    def _require_known(self) -> None:
        if self._follower.loss and not self._is_determined:
            raise TargetLost(
                f"lost the tapped place: {self._follower.loss}. Tap it again, or something near it"
            )

    async def _check(self) -> None:
        """Have what was followed checked against the tapped patch."""
        await self._follower.check()
        stops = {self._follower.frame_id, *(stop.frame_id for stop in self._stops)}
        self._stops = [each for each in self._follower.sightings if each.frame_id in stops]

    async def _renew(self, with_advice: bool) -> None:
        self._renewed_ns = self._context.clock.now_ns()
        sightings = self._sightings()
        if len(sightings) > 1 or self._known is not None:
            self._estimate = await self._context.compute.call(
                estimate, sightings, self._context.description, with_advice, False, self._known
            )
            if self._is_determined:
                self._follower.point_in_world = self._estimate.point_in_world
        self._show()

    def _sightings(self) -> list[Sighting]:
        """Return what the estimate rests on: the tapped frame, the stops, and some frames in between."""
        stops = {id(stop) for stop in self._stops}
        others = [each for each in self._follower.sightings if id(each) not in stops]
        return thinned(self._stops, others, _APART_DISTANCE, _APART_ANGLE)

    @property
    def _here(self) -> PlanarPose:
        return self._context.poses.newest()[1]

    @property
    def _first_ray(self) -> Ray:
        return ray_of(self._stops[0], self._context.description)

    def _supposed_distances(self, estimate: PointEstimate | None) -> tuple[float, ...]:
        tilt_sigma = radians(self._context.description.camera.mount.angle_sigma_deg)
        return supposed_distances(self._first_ray, estimate, tilt_sigma)

    @property
    def _way_left(self) -> float:
        return max(0.0, MOST_DRIVEN - self._driven)

    async def _choose(self) -> Choice | None:
        ahead = min(LONGEST_ADVANCE, self._way_left)
        seen = self._estimate
        return await self._context.compute.call(
            planned_move,
            self._sightings(),
            self._here,
            [self._first_ray.at(distance) for distance in self._supposed_distances(seen)],
            Room(ahead, min(ahead, way_behind(self._context.poses))),
            self._accuracy,
            seen is None or seen.heading_from is HeadingSource.BACKGROUND,
            self._context.description,
            self.keep_clear,
            tuple(self._lost_sides),
        )

    @property
    def _is_determined(self) -> bool:
        return self._estimate is not None and self._estimate.status is Status.DETERMINED

    async def _measure(self) -> None:
        """Find out how large the thing is, once it is known where."""
        if self._estimate is not None and self._is_determined:
            self._say("measure", 0.95, "measuring it in the pictures taken")
            self.size = await size_of(self._context, self._estimate, self._report.tap.box)

    def _conclusion(self, end: End) -> str:
        """Show why it ends and return the closing sentence."""
        found, loss = self._estimate, self._follower.loss
        if found is None or not self._is_determined:
            return self._no_position(self._target(not loss))
        reason = closing_reason(found.relative_sd, end, self._accuracy, self._way_left, loss, self._cut_short)
        doubt = self._follower.doubt
        target = self._target(not loss, f"{reason}; not confirmed: {doubt}" if doubt else reason)
        if self.size is not None and target.extent is None:
            extent = extent_of_thing(self.size, found.sightings[-1], self._context.description)
            target = replace(target, extent=extent)
        self._context.show_target(target)
        return closing_sentence(target)

    def _no_position(self, target: Target) -> str:
        if self._driven == 0.0:
            hidden = " and in sight" if self._lost_sides else ""
            clear = " and clear of what stands there" if self.keep_clear else ""
            why = f"no move keeps this in the picture{hidden}{clear}"
            return f"no position: {why}. Drive back or turn to it, and tap again"
        reason = self._cut_short if self._cut_short in (BLOCKED, SLIPPING) else target.reason
        return " ".join(part for part in (f"no position: {reason}.", target.advice) if part)

    def _show(self) -> None:
        self._context.show_target(self._target(not self._follower.loss, self._follower.loss))

    def _target(self, is_following: bool, reason: str = "") -> Target:
        seen, way = self._sightings(), self.way_since_seen
        return self._report.target(seen, self._estimate, is_following, reason, self._here, way)

    def _say(self, phase: str, progress: float, message: str) -> None:
        self._context.report(TaskReport(phase, progress, message))
