"""A framed session: greeting, set-up, clock alignment, acknowledgements. Bytes and time come from outside."""

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import Protocol

from tapreach.drivers.arduino.clock import BoardClock
from tapreach.drivers.arduino.fault_words import refusal_words
from tapreach.drivers.arduino.frame_reader import FrameReader, encode
from tapreach.drivers.arduino.pending import Pending
from tapreach.drivers.arduino.wire import (
    VERSION,
    Ack,
    FromFirmware,
    Hello,
    Moved,
    Ping,
    Pong,
    Result,
    Telemetry,
    ToFirmware,
    Welcome,
)
from tapreach.robot.clock import MS, SECOND, Clock

HELLO_EVERY_NS, HELLO_AFTER_REFUSAL_NS = 250 * MS, 2 * SECOND
SILENCE_NS = 600 * MS
"""Thirty telemetry messages missed: greet anew. The wheels have long been stopped by their own deadman."""
LONGEST_STEP_NS = 30 * MS
"""What one tick adds to a silence at most: where this program stalled, the board's words wait to be read."""
NO_ANSWER_NS = 4 * SECOND
"""Longer than a boot loader waits."""
PING_FAST_NS, PING_SLOW_NS, FAST_PINGS = 50 * MS, 1 * SECOND, 8
DEAF = 20
"""Unanswered commands in a row, while telemetry comes, after which the board does not hear us."""
WORDLESS = (Hello, Ping)
"""What is not acknowledged: it has an answer of its own."""


class Phase(StrEnum):
    """How far a session is."""

    CLOSED = "closed"
    GREETING = "greeting"
    SETTING_UP = "setting up"
    OPEN = "open"
    REFUSED = "refused"


class SessionEars(Protocol):
    """Who hears what happens in a session."""

    def on_phase(self, phase: Phase, reason: str) -> None:
        """The session has come to another phase; reason says why it is not open."""
        ...

    def on_restart(self, welcome: Welcome) -> None:
        """The board has restarted since the session before."""
        ...

    def on_telemetry(self, telemetry: Telemetry, captured_ns: int) -> None:
        """Telemetry, with its time by our clock."""
        ...

    def on_answer(self, message: ToFirmware, result: Result) -> None:
        """A command was acknowledged in time."""
        ...

    def on_moved(self, moved: Moved) -> None:
        """A relative move of the board has ended."""
        ...


class Session:
    """Speaks with a board. Call `tick` every 20 ms or so, `take` with what comes.

    `setup` gives the commands that every opening sends first; all must be acknowledged before it is open.
    """

    def __init__(
        self,
        clock: Clock,
        write: Callable[[bytes], None],
        ears: SessionEars,
        setup: Callable[[], Sequence[ToFirmware]],
    ) -> None:
        self._clock, self._write, self._ears, self._setup = clock, write, ears, setup
        self._reader = FrameReader()
        self._pending = Pending()
        self._pings: dict[int, int] = {}
        self._missing: list[ToFirmware] = []
        self._seq = self._token = self._trips = 0
        self._greeted_ns = self._pinged_ns = self._began_ns = self._ticked_ns = clock.now_ns()
        self._silent_ns = 0
        self.board_clock = BoardClock()
        self.phase = Phase.CLOSED
        self.welcome: Welcome | None = None

    @property
    def stale_answers(self) -> int:
        """Acknowledgements that came too late, or for nothing."""
        return self._pending.stale

    @property
    def bad_frames(self) -> int:
        """Pieces of the stream that were no message."""
        return self._reader.bad_frames

    def start(self) -> None:
        """The line is open: greet."""
        self._reader = FrameReader()
        self._greet("waiting for the board's welcome")

    def end(self) -> None:
        """The line is gone."""
        self._pending.forget()
        self.phase = Phase.CLOSED

    def send(self, message: ToFirmware) -> None:
        """Send a message now, under the next sequence number."""
        self._seq = (self._seq + 1) & 0xFF
        if not isinstance(message, WORDLESS):
            self._pending.note(self._seq, message, self._clock.now_ns())
        self._write(encode(message, self._seq))

    @property
    def at_ms(self) -> int:
        """The board's milliseconds now, as we believe; 0 before the first round trip."""
        return self.board_clock.board_ms(self._clock.now_ns()) or 0

    def take(self, data: bytes) -> None:
        """Take bytes from the line."""
        for received in self._reader.feed(data):
            if self.phase is not Phase.CLOSED and isinstance(received.message, FromFirmware):
                self._silent_ns = 0
                self._hear(received.message)

    def tick(self) -> None:
        """Do what the time asks for."""
        now_ns = self._clock.now_ns()
        self._silent_ns += min(now_ns - self._ticked_ns, LONGEST_STEP_NS)
        self._ticked_ns = now_ns
        for message in self._pending.overdue(now_ns):
            if message in self._missing:
                self.send(message)
        if self.phase in (Phase.GREETING, Phase.REFUSED):
            is_refused = self.phase is Phase.REFUSED
            every_ns = HELLO_AFTER_REFUSAL_NS if is_refused else HELLO_EVERY_NS
            if now_ns - self._greeted_ns >= every_ns:
                self._say_hello()
        elif self.phase is not Phase.CLOSED:
            self._watch()
            self._ping(now_ns)

    @property
    def is_without_answer(self) -> bool:
        """True when a greeting has had no answer for so long that the line should be opened anew."""
        waits = self.phase is Phase.GREETING
        return waits and self._clock.now_ns() - self._began_ns >= NO_ANSWER_NS

    def _greet(self, reason: str) -> None:
        self._began_ns = self._clock.now_ns()
        self._pending.forget()
        self._pings.clear()
        self._enter(Phase.GREETING, reason)
        self._say_hello()

    def _say_hello(self) -> None:
        self._greeted_ns = self._clock.now_ns()
        self.send(Hello(VERSION))

    def _watch(self) -> None:
        if self._silent_ns >= SILENCE_NS:
            self._greet("the board fell silent: check its supply and the cable")
        elif self._pending.unanswered_in_row >= DEAF:
            self._greet("the board talks and does not hear: check the wire to its RX pin")

    def _ping(self, now_ns: int) -> None:
        every_ns = PING_FAST_NS if self._trips < FAST_PINGS else PING_SLOW_NS
        if now_ns - self._pinged_ns < every_ns:
            return
        self._pinged_ns = now_ns
        self._token = (self._token + 1) % 2**32
        self._pings = {token: asked for token, asked in self._pings.items() if now_ns - asked < SECOND}
        self._pings[self._token] = now_ns
        self.send(Ping(self._token))

    def _hear(self, message: FromFirmware) -> None:
        if isinstance(message, Welcome):
            self._hear_welcome(message)
        elif self.phase not in (Phase.SETTING_UP, Phase.OPEN):
            return
        elif isinstance(message, Pong):
            self._hear_pong(message)
        elif isinstance(message, Ack):
            self._hear_ack(message)
        elif isinstance(message, Telemetry):
            self._hear_telemetry(message)
        else:
            self._ears.on_moved(message)

    def _hear_welcome(self, welcome: Welcome) -> None:
        known, self.welcome = self.welcome, welcome
        has_restarted = known is not None and known.boot_id != welcome.boot_id
        if known is None or has_restarted:
            self.board_clock.reset()
            self._trips = 0
        if has_restarted:
            self._ears.on_restart(welcome)
        if welcome.version != VERSION:
            self._enter(Phase.REFUSED, _wrong_version(welcome.version))
        elif self.phase in (Phase.GREETING, Phase.REFUSED) or has_restarted:
            self._set_up()

    def _set_up(self) -> None:
        self._enter(Phase.SETTING_UP, "setting the board up")
        self._pending.forget()
        self._missing = list(self._setup())
        self._pinged_ns = self._clock.now_ns() - PING_SLOW_NS
        self._ping(self._clock.now_ns())
        for message in tuple(self._missing):
            self.send(message)
        self._open_when_ready()

    def _hear_pong(self, pong: Pong) -> None:
        asked_ns = self._pings.pop(pong.token, None)
        if asked_ns is not None:
            self._trips += 1
            self.board_clock.take_trip(asked_ns, pong.at_us, self._clock.now_ns())
            self._open_when_ready()

    def _hear_ack(self, ack: Ack) -> None:
        if ack.result is Result.NO_SESSION:
            self._greet("the board knows no session: it restarted, or heard nothing for 2 s")
            return
        message = self._pending.settle(ack, self._clock.now_ns())
        if message is None:
            return
        if message in self._missing:
            self._missing.remove(message)
            if ack.result is not Result.OK:
                what = type(message).__name__
                self._enter(Phase.REFUSED, f"the board refuses {what}: {refusal_words(ack.result)}")
        self._ears.on_answer(message, ack.result)
        self._open_when_ready()

    def _hear_telemetry(self, telemetry: Telemetry) -> None:
        captured_ns = self.board_clock.time_of_ns(telemetry.at_us, self._clock.now_ns())
        if captured_ns is not None:
            self._ears.on_telemetry(telemetry, captured_ns)

    def _open_when_ready(self) -> None:
        if self.phase is Phase.SETTING_UP and not self._missing and self.board_clock.is_aligned:
            self._enter(Phase.OPEN, "")

    def _enter(self, phase: Phase, reason: str) -> None:
        self.phase = phase
        self._ears.on_phase(phase, reason)


def _wrong_version(version: int) -> str:
    newer = "a newer Tapreach is needed" if version > VERSION else "run: tapreach firmware flash"
    return f"the board's firmware speaks protocol version {version}, this program {VERSION}: {newer}"
