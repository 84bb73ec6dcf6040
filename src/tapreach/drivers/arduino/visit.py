"""A visit to the board alone: what it says of itself, and single commands with their answers."""

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Self

from tapreach.drivers.arduino.board import NO_FIRMWARE, NO_FRAMES
from tapreach.drivers.arduino.fault_words import refusal_words
from tapreach.drivers.arduino.link import Link
from tapreach.drivers.arduino.ports import OpenPort, open_port
from tapreach.drivers.arduino.session import Phase, Session
from tapreach.drivers.arduino.wire import Moved, Result, Stop, Telemetry, ToFirmware, Welcome
from tapreach.errors import DriverError, LinkLost
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.link_section import LinkSection

TICK_NS = 20 * MS
OPENING_NS = 8 * SECOND
"""Twice what a boot loader may take after a port was opened."""
TRIES = 2
SENDS, ANSWER_NS = 3, 300 * MS


class BoardVisit:
    """A framed session without a robot behind it. `async with` opens the port and closes it again.

    Nothing is sent but greeting and clock questions until `ask` or `send` is called; leaving sends a Stop.
    """

    def __init__(
        self,
        section: LinkSection,
        clock: Clock,
        setup: Sequence[ToFirmware] = (),
        open_port: OpenPort = open_port,
    ) -> None:
        self._clock, self._setup = clock, setup
        self.address = section.address
        self.session = Session(clock, self._write, self, lambda: self._setup)
        self._link = Link(section, clock, self.session.start, self.session.take, self._lost, open_port)
        self._answers: list[tuple[ToFirmware, Result]] = []
        self._tasks: list[asyncio.Task[None]] = []
        self._losses = 0
        self.reason = "the port is being opened"
        self.telemetry: Telemetry | None = None
        self.telemetry_count = 0
        self.on_each: Callable[[Telemetry], None] = lambda telemetry: None

    async def __aenter__(self) -> Self:
        self._tasks = [asyncio.create_task(work) for work in (self._link.run(), self._run())]
        return self

    async def __aexit__(self, *_: object) -> None:
        if self.is_open:
            self.session.send(Stop())
        for task in self._tasks:
            task.cancel()
        for task in self._tasks:
            with suppress(asyncio.CancelledError):
                await task
        self.session.end()

    @property
    def is_open(self) -> bool:
        """True while the board answers."""
        return self.session.phase is Phase.OPEN

    @property
    def _tells(self) -> bool:
        return self.is_open and self.telemetry is not None

    @property
    def _is_hopeless(self) -> bool:
        return self._losses >= TRIES or self.session.phase is Phase.REFUSED

    @property
    def welcome(self) -> Welcome | None:
        """What the board said of itself."""
        return self.session.welcome

    async def opened(self, patience_ns: int = OPENING_NS) -> bool:
        """Wait until the board answers; False where it does not after a second try, and `reason` says why."""
        await self.until(lambda: self._tells or self._is_hopeless, patience_ns)
        return self._tells

    async def until(self, holds: Callable[[], bool], patience_ns: int) -> bool:
        """Wait until it holds; False where it does not in time."""
        end_ns = self._clock.now_ns() + patience_ns
        while not holds():
            if self._clock.now_ns() >= end_ns:
                return False
            await self.pause(TICK_NS)
        return True

    async def pause(self, duration_ns: int) -> None:
        """Let time pass while the session goes on."""
        await self._clock.sleep_until(self._clock.now_ns() + duration_ns)

    async def ask(self, message: ToFirmware) -> Result:
        """Send a command, again where its answer is lost, and return the answer. Raises LinkLost."""
        self._answers.clear()
        for _ in range(SENDS):
            if not self.is_open:
                break
            self.session.send(message)
            await self.until(lambda: self._answer_to(message) is not None, ANSWER_NS)
            if (answer := self._answer_to(message)) is not None:
                return answer
        raise LinkLost(self.reason or "the board does not answer: check its cable")

    async def require(self, message: ToFirmware) -> None:
        """Like `ask`; raises DriverError with the reason where the board refuses."""
        result = await self.ask(message)
        if result is not Result.OK:
            raise DriverError(f"the board refuses {type(message).__name__}: {refusal_words(result)}")

    def _answer_to(self, message: ToFirmware) -> Result | None:
        return next((result for each, result in self._answers if each == message), None)

    def on_phase(self, phase: Phase, reason: str) -> None:
        """See SessionEars. Greeting again is no news: why the link was lost before says more."""
        if phase is not Phase.GREETING or not self._losses:
            self.reason = reason

    def on_restart(self, welcome: Welcome) -> None:
        """See SessionEars."""

    def on_telemetry(self, telemetry: Telemetry, captured_ns: int) -> None:
        """See SessionEars."""
        self.telemetry = telemetry
        self.telemetry_count += 1
        self.on_each(telemetry)

    def on_answer(self, message: ToFirmware, result: Result) -> None:
        """See SessionEars."""
        self._answers.append((message, result))

    def on_moved(self, moved: Moved) -> None:
        """See SessionEars."""

    def _write(self, data: bytes) -> None:
        self._link.write(data)

    def _lost(self, reason: str) -> None:
        self.session.end()
        self.telemetry = None
        self._losses += 1
        self.reason = reason

    async def _run(self) -> None:
        while True:
            self.session.tick()
            if self.session.is_without_answer and self._link.is_open:
                self._link.drop(NO_FRAMES if self.session.bad_frames else NO_FIRMWARE)
            await self._clock.sleep_until(self._clock.now_ns() + TICK_NS)
