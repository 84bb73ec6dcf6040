"""Requests about targets, tasks and guides; only who drives may make them."""

from tapreach.errors import InputError
from tapreach.geometry.pixel_box import PixelBox
from tapreach.server.messages import (
    Ack,
    GuideAct,
    GuideEnd,
    GuideStart,
    GuideTap,
    GuideValue,
    TapTarget,
    TargetClear,
    TaskCancel,
)
from tapreach.server.requests_of_driver import DriverRequests, done
from tapreach.server.visitor import Visitor
from tapreach.tasks.locate import ACCURACY
from tapreach.tasks.task import Tap


class TaskRequests(DriverRequests):
    """Of targets, tasks and guides; see DriverRequests."""

    async def tap(self, visitor: Visitor, request: TapTarget) -> Ack:
        """Locate what was tapped, or guess where it stands on the floor."""
        self._require_lease(visitor)
        box = PixelBox(*request.box) if request.box is not None else None
        tap = Tap(request.frame_id, request.u, request.v, box)
        if request.purpose == "floor":
            await self._station.tasks.guess_on_floor(tap)
        else:
            accuracy = ACCURACY if request.accuracy is None else request.accuracy
            self._station.tasks.locate(tap, visitor.session_id, accuracy)
        return done(request)

    def target_clear(self, visitor: Visitor, request: TargetClear) -> Ack:
        """Forget a target."""
        self._require_lease(visitor)
        self._station.tasks.target_cleared(request.target_id)
        if not self._station.targets.clear(request.target_id):
            raise InputError(f"there is no target {request.target_id}")
        return done(request)

    def task_cancel(self, visitor: Visitor, request: TaskCancel) -> Ack:
        """Stop the running task; anyone may, as with the emergency stop."""
        if not self._station.tasks.cancel(f"stopped by {visitor.name}"):
            raise InputError("no task is running")
        return done(request)

    async def guide_start(self, visitor: Visitor, request: GuideStart) -> Ack:
        """Begin a guide."""
        self._require_lease(visitor)
        await self._station.tasks.open_guide(request.kind, visitor.session_id)
        return done(request)

    async def guide_tap(self, visitor: Visitor, request: GuideTap) -> Ack:
        """Take a tap for the guide's step."""
        self._require_lease(visitor)
        guide = self._station.tasks.guide_of(visitor.session_id)
        await guide.tap(Tap(request.frame_id, request.u, request.v))
        return done(request)

    async def guide_value(self, visitor: Visitor, request: GuideValue) -> Ack:
        """Take a typed value."""
        self._require_lease(visitor)
        await self._station.tasks.guide_of(visitor.session_id).value(request.name, request.value)
        return done(request)

    async def guide_act(self, visitor: Visitor, request: GuideAct) -> Ack:
        """Do, or confirm, the guide's step."""
        self._require_lease(visitor)
        await self._station.tasks.guide_of(visitor.session_id).act(request.act)
        return done(request)

    async def guide_end(self, visitor: Visitor, request: GuideEnd) -> Ack:
        """Leave the guide."""
        self._station.tasks.guide_of(visitor.session_id)
        await self._station.tasks.end_guide()
        return done(request)
