"""What all requests that only who drives may make have in common."""

from tapreach.errors import InputError
from tapreach.server.message_base import Request
from tapreach.server.messages import Ack
from tapreach.server.station import Station
from tapreach.server.visitor import Visitor


class DriverRequests:
    """Each method of a subclass answers one kind of request; what it raises is answered by the session."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def _require_lease(self, visitor: Visitor) -> None:
        if not self._station.lease.is_held_by(visitor.session_id):
            raise InputError("you do not have the lease: ask to drive first")
        self._station.lease.command_given(visitor.session_id)


def done(request: Request) -> Ack:
    """Return the answer to a request that was carried out."""
    return Ack(seq=request.seq, ok=True)
