"""Requests about lessons; only who drives may make them."""

from tapreach.errors import InputError
from tapreach.server.message_base import Request
from tapreach.server.messages import Ack
from tapreach.server.messages_lesson import LessonAnswer, LessonEnd, LessonStart
from tapreach.server.station import Station
from tapreach.server.visitor import Visitor


class LessonRequests:
    """Each method answers one kind of request; what it raises is answered by the session."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def start(self, visitor: Visitor, request: LessonStart) -> Ack:
        """Begin a lesson."""
        self._require_lease(visitor)
        self._station.tasks.teach(request.lesson, visitor.session_id)
        return _done(request)

    def answer(self, visitor: Visitor, request: LessonAnswer) -> Ack:
        """Pass on what the person sees."""
        self._require_lease(visitor)
        self._station.tasks.lessons.answer(request.question_id, request.answer, visitor.session_id)
        return _done(request)

    def end(self, visitor: Visitor, request: LessonEnd) -> Ack:
        """Stop it, or put it away."""
        self._require_lease(visitor)
        self._station.tasks.lessons.end(visitor.name)
        return _done(request)

    def _require_lease(self, visitor: Visitor) -> None:
        if not self._station.lease.is_held_by(visitor.session_id):
            raise InputError("you do not have the lease: ask to drive first")
        self._station.lease.command_given(visitor.session_id)


def _done(request: Request) -> Ack:
    return Ack(seq=request.seq, ok=True)
