"""The person who sees the robot and decides: at a terminal, or at the page."""

from typing import Protocol

from tapreach.errors import TapreachError


class TeachingStopped(TapreachError):
    """The person has had enough; nothing is written."""


class Person(Protocol):
    """Who is asked, and told."""

    def tell(self, text: str) -> None:
        """Say something, of one line or several."""
        ...

    def show_change(self, difference: str) -> None:
        """Show how the robot file would change, as a unified diff."""
        ...

    async def ask(self, question: str, answers: tuple[str, ...]) -> str:
        """Return one of the answers. Raises TeachingStopped when the person stops instead."""
        ...
