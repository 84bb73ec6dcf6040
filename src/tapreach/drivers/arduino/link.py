"""The link to the board: opens it, opens it again, and says how it stands."""

import asyncio
from collections.abc import Callable
from contextlib import suppress

import serial

from tapreach.drivers.arduino.link_reason import why_ended, why_not_opened
from tapreach.drivers.arduino.ports import OpenPort, Port, open_port
from tapreach.robot.clock import MS, SECOND, Clock
from tapreach.robot.link_section import LinkSection

FIRST_WAIT_NS, LONGEST_WAIT_NS = 200 * MS, 5 * SECOND


class Link:
    """Keeps the address of a robot file open while `run` runs.

    found() when it is open, heard(bytes) with what comes, lost(reason) when it could not be opened or has
    ended; all in the event loop's thread. After a loss it waits 0.2 s, then twice as long each time up to
    5 s, until the link `serves`.
    """

    def __init__(
        self,
        section: LinkSection,
        clock: Clock,
        found: Callable[[], None],
        heard: Callable[[bytes], None],
        lost: Callable[[str], None],
        open_port: OpenPort = open_port,
    ) -> None:
        self._open_port = open_port
        self._section, self._clock = section, clock
        self._found, self._heard, self._lost = found, heard, lost
        self._port: Port | None = None
        self._ended: asyncio.Future[str] | None = None
        self._wait_ns = FIRST_WAIT_NS

    @property
    def is_open(self) -> bool:
        """True while bytes can be sent."""
        return self._port is not None

    def write(self, data: bytes) -> None:
        """Send now, never waiting; what cannot be sent now is dropped."""
        if self._port is not None:
            self._port.write(data)

    def drop(self, reason: str) -> None:
        """Close it and open it again: it is open and of no use."""
        if self._ended is not None and not self._ended.done():
            self._ended.set_result(reason)

    def serves(self) -> None:
        """The board answers: after the next loss the first wait is short again."""
        self._wait_ns = FIRST_WAIT_NS

    async def run(self) -> None:
        """Open, hear, open again, until cancelled."""
        while True:
            await self._serve_once()
            await self._clock.sleep_until(self._clock.now_ns() + self._wait_ns)
            self._wait_ns = min(2 * self._wait_ns, LONGEST_WAIT_NS)

    async def _serve_once(self) -> None:
        loop = asyncio.get_running_loop()
        ended: asyncio.Future[str] = loop.create_future()
        port = await self._open(loop, ended)
        if port is None:
            return
        self._port, self._ended = port, ended
        try:
            self._found()
            reason = await ended
        finally:
            self._port = self._ended = None
            await asyncio.shield(asyncio.to_thread(port.close))
        self._lost(reason)

    async def _open(self, loop: asyncio.AbstractEventLoop, ended: "asyncio.Future[str]") -> Port | None:
        def hear(data: bytes) -> None:
            with suppress(RuntimeError):  # the loop has been closed: nobody listens
                loop.call_soon_threadsafe(self._hear, ended, data)

        def end(error: BaseException | None) -> None:
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(_finish, ended, why_ended(self._section, error))

        opening = asyncio.ensure_future(asyncio.to_thread(self._open_port, self._section, hear, end))
        try:
            return await asyncio.shield(opening)
        except (serial.SerialException, OSError, ValueError) as error:
            self._lost(why_not_opened(self._section, error))
            return None
        except asyncio.CancelledError:
            with suppress(serial.SerialException, OSError, ValueError):
                await asyncio.to_thread((await opening).close)
            raise

    def _hear(self, ended: "asyncio.Future[str]", data: bytes) -> None:
        if not ended.done() and ended is self._ended:
            self._heard(data)


def _finish(ended: "asyncio.Future[str]", reason: str) -> None:
    if not ended.done():
        ended.set_result(reason)
