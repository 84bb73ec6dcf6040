"""Requests about fetching; only who drives may make them."""

from tapreach.errors import InputError
from tapreach.geometry.pixel_box import PixelBox
from tapreach.server.messages import Ack
from tapreach.server.messages_fetch import Fetch, FetchConfirm, FetchResume, FetchVerb
from tapreach.server.requests_of_driver import DriverRequests, done
from tapreach.server.visitor import Visitor
from tapreach.tasks.fetch.fetch_state import Mode, Verb
from tapreach.tasks.task import Tap


class FetchRequests(DriverRequests):
    """Of fetching; see DriverRequests."""

    def fetch(self, visitor: Visitor, request: Fetch) -> Ack:
        """Begin to fetch a tapped thing, or a known target."""
        self._require_lease(visitor)
        mode = Mode(request.mode)
        if request.target_id is not None:
            self._station.tasks.fetch_target(request.target_id, mode, visitor.session_id)
        else:
            self._station.tasks.fetch(_tap(request), mode, visitor.session_id)
        return done(request)

    def confirm(self, visitor: Visitor, request: FetchConfirm) -> Ack:
        """Pass on the operator's word."""
        self._require_lease(visitor)
        self._station.tasks.confirm_fetch()
        return done(request)

    def resume(self, visitor: Visitor, request: FetchResume) -> Ack:
        """Go on with what was stopped."""
        self._require_lease(visitor)
        self._station.tasks.resume_fetch(visitor.session_id)
        return done(request)

    def verb(self, visitor: Visitor, request: FetchVerb) -> Ack:
        """Do something with what is held."""
        self._require_lease(visitor)
        self._station.tasks.follow_up(Verb(request.verb), visitor.session_id)
        return done(request)


def _tap(request: Fetch) -> Tap:
    if request.frame_id is None or request.u is None or request.v is None:
        raise InputError("give the tap (frame_id, u, v) or the target_id of what to fetch")
    box = PixelBox(*request.box) if request.box is not None else None
    return Tap(request.frame_id, request.u, request.v, box)
