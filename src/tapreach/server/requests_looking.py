"""Requests that move nothing: who are you, what time is it, keep this picture."""

from tapreach.server.messages import Ack, Capture, Hello, Ping, Pong, Welcome
from tapreach.server.station import Station
from tapreach.server.views import camera_view
from tapreach.server.visitor import Visitor


class LookingRequests:
    """Each method answers one kind of request."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def hello(self, visitor: Visitor, request: Hello) -> Welcome:
        """Say who is who."""
        station = self._station
        station.guests.call(visitor.session_id, request.name)
        visitor.name = station.guests.name_of(visitor.session_id)
        if not visitor.has_said_hello:
            visitor.has_said_hello = True
            station.hub.join(visitor.outbox)
        station.tell_state()
        description = station.robot.description
        return Welcome(
            seq=request.seq,
            session_id=visitor.session_id,
            robot=description.name,
            camera=camera_view(description.camera),
            max_linear=description.base.max_linear,
            max_angular=description.base.max_angular,
            lessons=station.tasks.lessons.offered,
        )

    def ping(self, visitor: Visitor, request: Ping) -> Pong:
        """Tell the server's time."""
        now_ns = self._station.clock.now_ns()
        visitor.alignment.age_ns(request.client_ms, now_ns)
        return Pong(seq=request.seq, client_ms=request.client_ms, server_ns=now_ns)

    async def capture(self, visitor: Visitor, request: Capture) -> Ack:
        """Store a frame; anyone may."""
        capture_id = await self._station.capture(request.frame_id)
        return Ack(seq=request.seq, ok=True, reason=capture_id)
