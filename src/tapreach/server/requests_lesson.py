"""Requests about lessons; only who drives may make them."""

from tapreach.server.messages import Ack
from tapreach.server.messages_lesson import LessonAnswer, LessonEnd, LessonStart
from tapreach.server.requests_of_driver import DriverRequests, done
from tapreach.server.visitor import Visitor


class LessonRequests(DriverRequests):
    """Of lessons; see DriverRequests."""

    def start(self, visitor: Visitor, request: LessonStart) -> Ack:
        """Begin a lesson."""
        self._require_lease(visitor)
        self._station.tasks.teach(request.lesson, visitor.session_id)
        return done(request)

    def answer(self, visitor: Visitor, request: LessonAnswer) -> Ack:
        """Pass on what the person sees."""
        self._require_lease(visitor)
        self._station.tasks.lessons.answer(request.question_id, request.answer, visitor.session_id)
        return done(request)

    def end(self, visitor: Visitor, request: LessonEnd) -> Ack:
        """Stop it, or put it away."""
        self._require_lease(visitor)
        self._station.tasks.lessons.end(visitor.name)
        return done(request)
