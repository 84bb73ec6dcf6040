"""The person at the page, as a lesson asks: each question waits for its answer from a session."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace

from tapreach.errors import InputError


@dataclass(frozen=True, slots=True)
class Asked:
    """What is said and asked now. question: '' while nothing is."""

    said: tuple[str, ...] = ()
    change: str = ""
    question_id: int = 0
    question: str = ""
    answers: tuple[str, ...] = ()


class PagePerson:
    """See Person. on_change hears every change of `asked`."""

    def __init__(self, on_change: Callable[[Asked], None]) -> None:
        self._on_change = on_change
        self._answer: asyncio.Future[str] | None = None
        self._is_answered = False
        self.asked = Asked()

    def tell(self, text: str) -> None:
        """See Person. What was said stays until something else is said after an answer."""
        said = (text,) if self._is_answered else (*self.asked.said, text)
        self._is_answered = False
        self._show(replace(self.asked, said=said))

    @property
    def last_words(self) -> tuple[str, ...]:
        """What was said since the last answer."""
        return () if self._is_answered else self.asked.said

    def show_change(self, difference: str) -> None:
        """See Person."""
        self._show(replace(self.asked, change=difference))

    async def ask(self, question: str, answers: tuple[str, ...]) -> str:
        """See Person. Whoever stops the lesson cancels this."""
        self._answer = asyncio.get_running_loop().create_future()
        question_id = self.asked.question_id + 1
        self._show(replace(self.asked, question_id=question_id, question=question, answers=answers))
        try:
            return await self._answer
        finally:
            self._answer, self._is_answered = None, True
            self._show(Asked(said=self.asked.said, question_id=question_id))

    def answer(self, question_id: int, answer: str) -> None:
        """Take an answer. Raises InputError for one to another question, or that is none."""
        if self._answer is None or self._answer.done() or question_id != self.asked.question_id:
            raise InputError("this question is not asked any more")
        if answer not in self.asked.answers:
            raise InputError(f"{answer!r} is none of the answers: {', '.join(self.asked.answers)}")
        self._answer.set_result(answer)

    def _show(self, asked: Asked) -> None:
        self.asked = asked
        self._on_change(asked)
