"""The person at the terminal."""

import asyncio
import os
import sys
from typing import TextIO

from tapreach.errors import InputError
from tapreach.tasks.teaching.person import TeachingStopped

STOP_WORDS = ("stop", "q", "quit")


class Terminal:
    """See Person. Waiting for a line does not hold up the session with the board."""

    def __init__(
        self, option: str = "--teach", source: TextIO | None = None, target: TextIO | None = None
    ) -> None:
        self._source, self._target = source or sys.stdin, target or sys.stdout
        if not self._source.isatty():
            raise InputError(
                f"{option} moves the robot and asks what is seen: it needs a person at a terminal"
            )

    def tell(self, text: str) -> None:
        """See Person."""
        self._target.write(f"{text}\n")
        self._target.flush()

    def show_change(self, difference: str) -> None:
        """See Person."""
        self.tell(f"\n{difference}")

    async def ask(self, question: str, answers: tuple[str, ...]) -> str:
        """See Person. The end of the input stops."""
        while True:
            self._target.write(f"{question} [{'/'.join(answers)}/stop] ")
            self._target.flush()
            said = (await self._line()).strip().lower()
            if said in STOP_WORDS:
                raise TeachingStopped("stopped; nothing was written")
            if said in answers:
                return said
            self.tell(f"{said!r} is none of these: {', '.join(answers)}, stop")

    async def _line(self) -> str:
        loop, fd = asyncio.get_running_loop(), self._source.fileno()
        readable = asyncio.Event()
        loop.add_reader(fd, readable.set)
        try:
            await readable.wait()
            # A terminal hands over whole lines: one read is one answer.
            return os.read(fd, 1024).decode(errors="replace") or "stop"
        finally:
            loop.remove_reader(fd)
