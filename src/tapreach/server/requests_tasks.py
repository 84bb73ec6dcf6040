"""Requests about targets, tasks and guides."""

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
from tapreach.server.station import Station
from tapreach.server.visitor import Visitor

_NOT_YET = "not available"


class TaskRequests:
    """Each method answers one kind of request."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def tap(self, visitor: Visitor, request: TapTarget) -> Ack:
        """Locate what was tapped, or guess where it stands on the floor."""
        return Ack(seq=request.seq, ok=False, reason=_NOT_YET)

    def target_clear(self, visitor: Visitor, request: TargetClear) -> Ack:
        """Forget a target."""
        is_gone = self._station.targets.clear(request.target_id)
        reason = "" if is_gone else f"there is no target {request.target_id}"
        return Ack(seq=request.seq, ok=is_gone, reason=reason)

    def task_cancel(self, visitor: Visitor, request: TaskCancel) -> Ack:
        """Stop the running task."""
        was_running = self._station.tasks.cancel(f"stopped by {visitor.name}")
        return Ack(seq=request.seq, ok=was_running, reason="" if was_running else "no task is running")

    def guide_start(self, visitor: Visitor, request: GuideStart) -> Ack:
        """Begin a guide."""
        return Ack(seq=request.seq, ok=False, reason=_NOT_YET)

    def guide_step(self, visitor: Visitor, request: GuideTap | GuideValue | GuideAct | GuideEnd) -> Ack:
        """Go on with the guide."""
        return Ack(seq=request.seq, ok=False, reason=_NOT_YET)
