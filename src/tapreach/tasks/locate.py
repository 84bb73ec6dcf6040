"""Automatic locating: one tap; the robot moves a little, follows the tapped place, and says where it is."""

from collections.abc import Coroutine
from math import degrees, radians
from typing import Any

from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.geometry.planar_motion import PlanarStep
from tapreach.robot.clock import MS
from tapreach.tasks.aiming import aimed
from tapreach.tasks.estimating import estimate
from tapreach.tasks.follower import Follower, TargetLost, thinned
from tapreach.tasks.move_choice import Choice, choose_move
from tapreach.tasks.sighting import Sighting, ray_of
from tapreach.tasks.supposed_distance import supposed_distances
from tapreach.tasks.target import Target, TargetSource
from tapreach.tasks.target_report import TargetReport
from tapreach.tasks.task import Tap, TaskContext, TaskReport

MOST_MOVES = 4
MOST_DRIVEN = 0.5
"""Way [m] that locating may drive in all."""
FIRST_ADVANCE = 0.22
"""The first advance is kept short [m]: how far the target is becomes known only on the way."""
WORTHWHILE = 0.75
"""Another move is made when it promises to bring the range's error below this share of what it is."""
GOOD_RELATIVE_SD = 0.02
_LEAST_TURN = radians(0.5)
_SHOW_EVERY_NS = 250 * MS
_APART_DISTANCE, _APART_ANGLE = 0.05, radians(6.0)


class LocateTask:
    """Locate what was tapped. Shows the target under `target_id` from the first moment on."""

    kind = "locate"

    def __init__(self, tap: Tap, target_id: int, use_background: bool = True) -> None:
        self._tap = tap
        self._target_id = target_id
        self._use_background = use_background

    async def run(self, context: TaskContext) -> str:
        """See Task. Raises FrameError, InputError, TargetLost, MotionInterrupted, LinkLost."""
        tap = await aimed(context, self._tap)
        follower = Follower(context, tap, key=self._target_id, uses_background=self._use_background)
        report = TargetReport(self._target_id, TargetSource.LOCATE, tap, context.description)
        try:
            return await _Locating(context, follower, report).run()
        finally:
            await follower.close()


class _Locating:
    """One run of the task."""

    def __init__(self, context: TaskContext, follower: Follower, report: TargetReport) -> None:
        self._context = context
        self._follower = follower
        self._report = report
        self._stops: list[Sighting] = []
        self._estimate: PointEstimate | None = None
        self._driven = 0.0
        self._shown_ns = 0

    async def run(self) -> str:
        context, follower = self._context, self._follower
        self._say("look", 0.0, "looking at the tapped place")
        self._stops.append(await follower.open())
        self._show()
        await follower.catch_up()
        self._say("arm", 0.05, "bringing the arm to its standard pose, out of the picture")
        await self._while_following(context.pilot.move_arm(context.description.arm.standard.pose()))
        await self._look()
        for move in range(MOST_MOVES):
            choice = await self._choose()
            if choice is None or not self._is_worthwhile(choice):
                break
            self._say("move", 0.1 + 0.8 * move / MOST_MOVES, _preview(choice.step))
            await self._make(choice.step)
        await self._renew(with_advice=True)
        return self._conclusion()

    async def _make(self, step: PlanarStep) -> None:
        """Turn, look, advance, look."""
        if abs(step.turn) > _LEAST_TURN:
            await self._while_following(self._context.pilot.turn(step.turn))
            await self._look()
        await self._while_following(self._context.pilot.advance(step.advance))
        self._driven += step.advance
        await self._look()

    async def _while_following(self, motion: Coroutine[Any, Any, object]) -> None:
        await self._follower.during(motion, self._refresh)

    async def _look(self) -> None:
        """Take a sighting at rest and renew the estimate. Raises TargetLost when it is not seen
        and not known.
        """
        sighting = await self._follower.look()
        if sighting is not None:
            self._stops.append(sighting)
        await self._renew(with_advice=False)
        if sighting is None and not self._is_determined:
            raise TargetLost(
                f"lost the tapped place: {self._follower.loss}. Tap it again, or something near it"
            )

    async def _refresh(self) -> None:
        """Renew what is shown on the way, a few times a second.

        The estimate only once it is sharp: before, its range interval takes longer to compute than a frame
        lasts.
        """
        if self._context.clock.now_ns() - self._shown_ns < _SHOW_EVERY_NS:
            return
        if self._estimate is not None and self._estimate.is_ellipsoid_fair:
            await self._renew(with_advice=False)
        else:
            self._show()

    async def _renew(self, with_advice: bool) -> None:
        sightings = self._sightings()
        if len(sightings) > 1:
            self._estimate = await self._context.compute.call(
                estimate, sightings, self._context.description, with_advice
            )
            self._tell_follower()
        self._show()

    def _sightings(self) -> list[Sighting]:
        """Return what the estimate rests on: the tapped frame, the stops, and some frames in between."""
        stops = {id(stop) for stop in self._stops}
        others = [each for each in self._follower.sightings if id(each) not in stops]
        return thinned(self._stops, others, _APART_DISTANCE, _APART_ANGLE)

    def _tell_follower(self) -> None:
        if self._is_determined and self._estimate is not None:
            self._follower.point_in_world = self._estimate.point_in_world

    async def _choose(self) -> Choice | None:
        first_ray = ray_of(self._stops[0], self._context.description)
        distances = supposed_distances(first_ray, self._estimate)
        most = FIRST_ADVANCE if self._driven == 0.0 else MOST_DRIVEN - self._driven
        return await self._context.compute.call(
            choose_move,
            self._sightings(),
            self._follower.last.world_from_base,
            [first_ray.at(distance) for distance in distances],
            most,
            self._context.description,
        )

    def _is_worthwhile(self, choice: Choice) -> bool:
        """Tell whether a move is needed: always one, then while it promises much and the answer
        is not good.
        """
        if self._follower.loss:
            return False
        if self._driven == 0.0 or self._estimate is None or not self._is_determined:
            return True
        now = self._estimate.relative_sd
        return now > GOOD_RELATIVE_SD and choice.relative_sd < WORTHWHILE * now

    @property
    def _is_determined(self) -> bool:
        return self._estimate is not None and self._estimate.status is Status.DETERMINED

    def _conclusion(self) -> str:
        """Return the closing sentence. Raises TargetLost when the place was lost before its range
        was known.
        """
        target = self._report.target(self._sightings(), self._estimate, not self._follower.loss)
        if target.range is None or target.range_interval is None:
            return self._no_position(target)
        low, high = target.range_interval
        sentence = f"{target.range:.2f} m away (95 %: {low:.2f} to {high:.2f} m)"
        if self._follower.loss:
            sentence += f"; lost on the way ({self._follower.loss}), from the views before"
        return sentence

    def _no_position(self, target: Target) -> str:
        if self._driven == 0.0:
            return "no position: no move keeps this in the picture. Drive back or turn to it, and tap again"
        return " ".join(part for part in (f"no position: {target.reason}.", target.advice) if part)

    def _show(self) -> None:
        self._shown_ns = self._context.clock.now_ns()
        is_following = not self._follower.loss
        target = self._report.target(self._sightings(), self._estimate, is_following, self._follower.loss)
        self._context.show_target(target)

    def _say(self, phase: str, progress: float, message: str) -> None:
        self._context.report(TaskReport(phase, progress, message))


def _preview(step: PlanarStep) -> str:
    side = "left" if step.turn > 0.0 else "right"
    turn = f"turning {abs(degrees(step.turn)):.0f}° {side}, then " if abs(step.turn) > _LEAST_TURN else ""
    return f"{turn}driving {100.0 * step.advance:.0f} cm forward"
