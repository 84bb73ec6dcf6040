"""A visit to the board alone: what it says of itself, and single commands with their answers."""

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Self

from tapreach.drivers.arduino.board import NO_FIRMWARE, NO_FRAMES
from tapreach.drivers.arduino.link import Link
from tapreach.drivers.arduino.ports import OpenPort, open_port
from tapreach.drivers.arduino.session import Phase, Session
from tapreach.drivers.arduino.talk import TICK_NS, Talk
from tapreach.drivers.arduino.wire import Moved, Result, Stop, Telemetry, ToFirmware, Welcome
from tapreach.robot.clock import SECOND, Clock
from tapreach.robot.link_section import LinkSection

OPENING_NS = 8 * SECOND
"""Twice what a boot loader may take after a port was opened."""
TRIES = 2


class BoardVisit:
    """A framed session without a robot behind it. `async with` opens the port and closes it again.

    Nothing is sent but greeting and clock questions, and what is said through `talk`; leaving sends a Stop.
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
        self.talk = Talk(self.session, clock, lambda: self.reason)
        self._tasks: list[asyncio.Task[None]] = []
        self._losses = 0
        self.reason = "the port is being opened"
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
        return self.talk.is_open

    @property
    def telemetry(self) -> Telemetry | None:
        """What the board told last; None while it is out of reach."""
        return self.talk.telemetry

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
        await self.talk.until(lambda: self._tells or self._is_hopeless, patience_ns)
        return self._tells

    def on_phase(self, phase: Phase, reason: str) -> None:
        """See SessionEars. Greeting again is no news: why the link was lost before says more."""
        if phase is not Phase.GREETING or not self._losses:
            self.reason = reason

    def on_restart(self, welcome: Welcome) -> None:
        """See SessionEars."""

    def on_telemetry(self, telemetry: Telemetry, captured_ns: int) -> None:
        """See SessionEars."""
        self.talk.on_telemetry(telemetry)
        self.telemetry_count += 1
        self.on_each(telemetry)

    def on_answer(self, message: ToFirmware, result: Result) -> None:
        """See SessionEars."""
        self.talk.on_answer(message, result)

    def on_moved(self, moved: Moved) -> None:
        """See SessionEars."""

    def _write(self, data: bytes) -> None:
        self._link.write(data)

    def _lost(self, reason: str) -> None:
        self.session.end()
        self.talk.lose()
        self._losses += 1
        self.reason = reason

    async def _run(self) -> None:
        while True:
            self.session.tick()
            if self.session.is_without_answer and self._link.is_open:
                self._link.drop(NO_FRAMES if self.session.bad_frames else NO_FIRMWARE)
            await self._clock.sleep_until(self._clock.now_ns() + TICK_NS)
