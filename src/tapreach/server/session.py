"""`/ws/control`: one page's commands in, answers and news out."""

import asyncio
import inspect
import logging

from starlette.websockets import WebSocket

from tapreach.errors import TapreachError
from tapreach.robot.clock import SECOND
from tapreach.server.background import run_until_first_ends
from tapreach.server.dispatch import Answer, Answerer, answerers
from tapreach.server.messages import Ack, EmergencyStop, FromPage, Hello
from tapreach.server.parsing import parsed
from tapreach.server.station import Station
from tapreach.server.visitor import Visitor

_log = logging.getLogger(__name__)

MOST_PENDING = 8
"""Requests of one session that may be waiting for a file or a computation."""
RATE_HZ = 400
BURST = 200
"""A session is read no faster than this, so that a flood cannot take the loop from others."""


class Session:
    """Reads, answers every message exactly once, and never dies of what it reads."""

    def __init__(self, socket: WebSocket, station: Station) -> None:
        self._socket = socket
        self._station = station
        session_id = station.guests.arrive()
        self._visitor = Visitor(session_id, station.guests.name_of(session_id))
        self._answerers = answerers(station)
        self._pending: set[asyncio.Task[None]] = set()
        self._credit = float(BURST)
        self._credit_ns = station.clock.now_ns()

    async def run(self) -> None:
        """Serve until the socket closes; then the operator's wheels stop at once."""
        try:
            await self._socket.accept()
            await run_until_first_ends(self._read(), self._write())
        finally:
            self._station.hub.leave(self._visitor.outbox)
            self._station.session_gone(self._visitor.session_id)
            for task in self._pending:
                task.cancel()

    async def _read(self) -> None:
        while True:
            await self._visitor.outbox.room()
            await self._spend_credit()
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            text = message.get("text")
            self._take(text if text is not None else message.get("bytes") or b"")

    async def _write(self) -> None:
        while True:
            await self._socket.send_text(await self._visitor.outbox.next())

    def _take(self, raw: str | bytes) -> None:
        request = parsed(raw)
        if isinstance(request, Ack):
            self._say(request)
        elif not self._visitor.has_said_hello and not isinstance(request, Hello | EmergencyStop):
            self._say(Ack(seq=request.seq, ok=False, reason=f"say hello before {request.type}"))
        else:
            self._dispatch(request)

    def _dispatch(self, request: FromPage) -> None:
        answerer = self._answerers[type(request)]
        if inspect.iscoroutinefunction(answerer) and len(self._pending) >= MOST_PENDING:
            reason = f"{MOST_PENDING} requests are being worked on; wait for an answer"
            self._say(Ack(seq=request.seq, ok=False, reason=reason))
            return
        if inspect.iscoroutinefunction(answerer):
            task = asyncio.create_task(self._answer_later(answerer, request))
            self._pending.add(task)
            task.add_done_callback(self._pending.discard)
            return
        try:
            self._say(answerer(self._visitor, request))
        except Exception as error:
            self._say(refusal_for(request, error))

    async def _answer_later(self, answerer: Answerer, request: FromPage) -> None:
        try:
            self._say(await answerer(self._visitor, request))
        except Exception as error:
            self._say(refusal_for(request, error))

    def _say(self, answer: Answer) -> None:
        self._visitor.outbox.answer(answer.model_dump_json())

    async def _spend_credit(self) -> None:
        clock = self._station.clock
        now_ns = clock.now_ns()
        self._credit = min(BURST, self._credit + RATE_HZ * (now_ns - self._credit_ns) / SECOND) - 1.0
        self._credit_ns = now_ns
        if self._credit < 0.0:
            await clock.sleep_until(now_ns + round(-self._credit / RATE_HZ * SECOND))


def refusal_for(request: FromPage, error: Exception) -> Ack:
    """Return the answer to a request that failed; what is no refusal of ours is logged."""
    if isinstance(error, TapreachError):
        return Ack(seq=request.seq, ok=False, reason=str(error))
    _log.error("request %r failed unexpectedly", request.type, exc_info=error)
    reason = f"{request.type} met an error of the program; the log has the details"
    return Ack(seq=request.seq, ok=False, reason=reason)
