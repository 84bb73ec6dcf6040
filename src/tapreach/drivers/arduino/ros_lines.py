"""Lines of ros_arduino_bridge: one question at a time, one answer to each, paired by order alone."""

import re
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from tapreach.robot.clock import MS, Clock

ANSWER_WITHIN_NS = 150 * MS
LONGEST_LINE = 64
INVALID = "Invalid Command"
_COUNTS = re.compile(r"(-?\d{1,10}) (-?\d{1,10})")
Answer = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class _Question:
    line: str
    answer: Answer


class RosLines:
    """Asks and hears answers; '' is told where none came in time.

    There is no checksum, number or echo: after a late or odd answer, pairs might be shifted. Then nothing is
    asked for the length of a time-out, whatever comes meanwhile is dropped, and the next question is fresh.
    """

    def __init__(self, clock: Clock, write: Callable[[bytes], None]) -> None:
        self._clock, self._write = clock, write
        self._waiting: deque[_Question] = deque()
        self._asked: _Question | None = None
        self._asked_ns = 0
        self._quiet_until_ns = 0
        self._text = bytearray()
        self.timeouts_in_row = 0
        self.odd_answers = 0

    def restart(self) -> None:
        """Forget all: the line is new."""
        self._waiting.clear()
        self._asked = None
        self._text.clear()
        self.timeouts_in_row = 0
        # An open CR ends what an earlier program left half written.
        self._write(b"\r")
        self._quiet_until_ns = self._clock.now_ns() + ANSWER_WITHIN_NS

    def ask(self, line: str, answer: Answer, is_urgent: bool = False) -> None:
        """Ask when the line is free; urgent questions come before all that wait."""
        question = _Question(line, answer)
        if is_urgent:
            self._waiting.appendleft(question)
        else:
            self._waiting.append(question)
        self._go_on()

    @property
    def is_idle(self) -> bool:
        """True when nothing waits and nothing is asked."""
        return self._asked is None and not self._waiting

    def take(self, data: bytes) -> None:
        """Take bytes from the line. Answers end by LF; what is too long is cut."""
        for byte in data:
            if byte == 0x0A:
                line = self._text.decode("ascii", "replace").strip()
                self._text.clear()
                self._hear(line)
            elif len(self._text) < LONGEST_LINE:
                self._text.append(byte)

    def tick(self) -> None:
        """Give up a question that has no answer, and go on."""
        now_ns = self._clock.now_ns()
        if self._asked is not None and now_ns - self._asked_ns > ANSWER_WITHIN_NS:
            late = self._asked
            self.timeouts_in_row += 1
            self._doubt()
            late.answer("")
        self._go_on()

    def doubt(self) -> None:
        """An answer was not what the question asks for: let the line fall quiet."""
        self.odd_answers += 1
        self._doubt()

    def _doubt(self) -> None:
        self._asked = None
        self._quiet_until_ns = self._clock.now_ns() + ANSWER_WITHIN_NS

    def _hear(self, line: str) -> None:
        if self._asked is None or not line:
            return
        asked, self._asked = self._asked, None
        self.timeouts_in_row = 0
        asked.answer(line)
        self._go_on()

    def _go_on(self) -> None:
        if self._asked is None and self._waiting and self._clock.now_ns() >= self._quiet_until_ns:
            self._asked, self._asked_ns = self._waiting.popleft(), self._clock.now_ns()
            self._write(self._asked.line.encode("ascii") + b"\r")

    @property
    def asked_ns(self) -> int:
        """When the question was sent whose answer came last."""
        return self._asked_ns


def counts_of(line: str) -> tuple[int, int] | None:
    """Return the two encoder counts of an answer; None for anything else, which is never taken as 0."""
    found = _COUNTS.fullmatch(line)
    return (int(found.group(1)), int(found.group(2))) if found else None
