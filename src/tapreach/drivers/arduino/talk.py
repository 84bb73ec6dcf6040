"""Commands to a board with their answers, over a session that somebody else looks after."""

from collections.abc import Callable

from tapreach.drivers.arduino.fault_words import refusal_words
from tapreach.drivers.arduino.session import Phase, Session
from tapreach.drivers.arduino.wire import Result, Telemetry, ToFirmware
from tapreach.errors import DriverError, LinkLost
from tapreach.robot.clock import MS, Clock

TICK_NS = 20 * MS
SENDS, ANSWER_NS = 3, 300 * MS


class Talk:
    """One question at a time. Whoever hears the session passes on telemetry and answers.

    reason: says why the board is out of reach.
    """

    def __init__(self, session: Session, clock: Clock, reason: Callable[[], str]) -> None:
        self.session, self.clock, self._reason = session, clock, reason
        self._asked: ToFirmware | None = None
        self.answer: Result | None = None
        self.telemetry: Telemetry | None = None

    @property
    def is_open(self) -> bool:
        """True while the board answers."""
        return self.session.phase is Phase.OPEN

    @property
    def reason(self) -> str:
        """Why it does not."""
        return self._reason() or "the board does not answer: check its cable"

    def say(self, message: ToFirmware) -> None:
        """Send a command; `answer` will be its answer, and None as long as there is none. Raises LinkLost."""
        if not self.is_open:
            raise LinkLost(self.reason)
        self._asked, self.answer = message, None
        self.session.send(message)

    async def ask(self, message: ToFirmware) -> Result:
        """Send a command, again where its answer is lost, and return the answer. Raises LinkLost."""
        for _ in range(SENDS):
            self.say(message)
            await self.until(lambda: self.answer is not None, ANSWER_NS)
            if self.answer is not None:
                return self.answer
        raise LinkLost(self.reason)

    async def require(self, message: ToFirmware) -> None:
        """Like `ask`; raises DriverError with the reason where the board refuses."""
        result = await self.ask(message)
        if result is not Result.OK:
            raise DriverError(f"the board refuses {type(message).__name__}: {refusal_words(result)}")

    async def until(self, holds: Callable[[], bool], patience_ns: int) -> bool:
        """Wait until it holds; False where it does not in time."""
        end_ns = self.clock.now_ns() + patience_ns
        while not holds():
            if self.clock.now_ns() >= end_ns:
                return False
            await self.pause(TICK_NS)
        return True

    async def pause(self, duration_ns: int) -> None:
        """Let time pass while the session goes on."""
        await self.clock.sleep_until(self.clock.now_ns() + duration_ns)

    def on_telemetry(self, telemetry: Telemetry) -> None:
        """Take what the board told."""
        self.telemetry = telemetry

    def on_answer(self, message: ToFirmware, result: Result) -> None:
        """Take the answer to a command."""
        if message == self._asked and self.answer is None:
            self.answer = result

    def lose(self) -> None:
        """The board is out of reach: what it told last counts no more."""
        self.telemetry = None
