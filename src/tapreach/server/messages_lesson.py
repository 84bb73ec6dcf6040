"""Messages about lessons, in which a person teaches the robot about itself; a part of messages.py."""

from typing import Literal

from pydantic import Field

from tapreach.server.message_base import Message, Request

LessonName = Literal["motors", "encoders", "servos"]


class LessonStart(Request):
    """Begin a lesson; what is running must have ended."""

    type: Literal["lesson_start"]
    lesson: LessonName


class LessonAnswer(Request):
    """Answer the question that is being asked."""

    type: Literal["lesson_answer"]
    question_id: int = Field(description="of the question on the screen; an older one is refused")
    answer: str = Field(max_length=20, description="one of the question's answers")


class LessonEnd(Request):
    """Stop the lesson at once, or put away what is said of one that has ended."""

    type: Literal["lesson_end"]


class LessonView(Message):
    """A lesson: what was said last, and what is asked now."""

    type: Literal["lesson"] = "lesson"
    lesson: LessonName | None = Field(description="null: there is none")
    said: tuple[str, ...] = ()
    change: str = Field("", description="how the robot file would change, as a unified diff")
    question_id: int = 0
    question: str = Field("", description="empty while the robot moves, and after the end")
    answers: tuple[str, ...] = ()
    ended: Literal["", "done", "failed", "cancelled"] = ""
    outcome: str = Field("", description="how it ended")


NO_LESSON = LessonView(lesson=None)
