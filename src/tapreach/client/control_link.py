"""The control socket from a script's side: numbered requests, one answer each, and the news in between."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator, Callable, Mapping
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from tapreach.client.address import ServerAddress
from tapreach.errors import LinkLost, SetupError, TapreachError
from tapreach.robot.clock import SECOND, Clock

Message = Mapping[str, Any]
Listener = Callable[[Message], None]
Unsubscribe = Callable[[], None]

PING_S, PING_TIMEOUT_S, CLOSE_S = 5.0, 10.0, 1.0
"""As the server's own: after so long a silence the socket is given up."""
_ANSWERS = ("ack", "pong", "welcome")


class RequestRefused(TapreachError):
    """The server does not do what was asked, and says why."""


class ControlLink:
    """One session. Answers and news pass through `listen` in the order in which they come."""

    def __init__(self, socket: ClientConnection, clock: Clock) -> None:
        self.clock = clock
        self._socket = socket
        self._seq = 0
        self._waiting: dict[int, tuple[asyncio.Future[Message], Callable[[], None]]] = {}
        self._listeners: list[Listener] = []
        self._heard = asyncio.Event()
        self._lost: TapreachError | None = None

    async def ask(
        self, kind: str, *, on_answer: Callable[[], None] = lambda: None, **fields: object
    ) -> Message:
        """Send a request and return its answer. Raises RequestRefused with the server's reason, LinkLost.

        on_answer: called when the answer has come and nothing that the server said after it.
        """
        answer: asyncio.Future[Message] = asyncio.get_running_loop().create_future()
        self._waiting[self._seq + 1] = answer, on_answer
        await self.tell(kind, **fields)
        await self.until(answer.done)
        message = answer.result()
        if not message.get("ok", True):
            raise RequestRefused(str(message.get("reason", f"{kind} was refused")))
        return message

    async def tell(self, kind: str, **fields: object) -> None:
        """Send a request whose answer does not matter. Raises LinkLost."""
        if self._lost is not None:
            raise self._lost
        self._seq += 1
        text = json.dumps({"type": kind, "seq": self._seq, **fields})
        try:
            await self._socket.send(text)
        except ConnectionClosed as error:
            raise LinkLost(_why_closed(error)) from error

    def subscribe(self, listener: Listener) -> Unsubscribe:
        """Call `listener` with every piece of news from now on, until the returned function is called."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    async def until(self, holds: Callable[[], Any]) -> None:
        """Return as soon as something that was heard makes `holds` true. Raises LinkLost."""
        while not holds():
            if self._lost is not None:
                raise self._lost
            await self._heard.wait()

    async def is_so_within(self, holds: Callable[[], Any], seconds: float) -> bool:
        """Wait as `until`, and return False when it takes longer. Raises LinkLost."""
        waiting = asyncio.ensure_future(self.until(holds))
        timer = asyncio.ensure_future(self.clock.sleep_until(self.clock.now_ns() + round(seconds * SECOND)))
        try:
            await asyncio.wait({waiting, timer}, return_when=asyncio.FIRST_COMPLETED)
            if waiting.done():
                waiting.result()
            return waiting.done()
        finally:
            waiting.cancel()
            timer.cancel()

    async def listen(self) -> None:
        """Read until the socket closes; whoever waits then gets LinkLost."""
        try:
            async for text in self._socket:
                self._take(json.loads(text))
                self._wake()
            self._lost = LinkLost("the server has closed the connection")
        except ConnectionClosed as error:
            self._lost = LinkLost(_why_closed(error))
        except (ValueError, KeyError) as error:
            self._lost = TapreachError(f"the server said something that cannot be read: {error}")
        finally:
            self._lost = self._lost or LinkLost("the connection is closed")
            self._wake()

    def _take(self, message: Message) -> None:
        if message["type"] in _ANSWERS:
            answer, on_answer = self._waiting.pop(message["seq"], (None, None))
            if answer is not None and on_answer is not None and not answer.done():
                answer.set_result(message)
                on_answer()
        else:
            for listener in tuple(self._listeners):
                listener(message)

    def _wake(self) -> None:
        self._heard.set()
        self._heard = asyncio.Event()


@contextlib.asynccontextmanager
async def open_link(address: ServerAddress, clock: Clock) -> AsyncIterator[ControlLink]:
    """Yield a link while the block runs. Raises SetupError, saying what to do, where no server answers."""
    socket = await _opened(address)
    link = ControlLink(socket, clock)
    listening = asyncio.create_task(link.listen(), name="control link")
    try:
        yield link
    finally:
        await socket.close()
        listening.cancel()
        (ended,) = await asyncio.gather(listening, return_exceptions=True)
        if isinstance(ended, Exception):
            raise ended


async def _opened(address: ServerAddress) -> ClientConnection:
    try:
        # No proxy: the robot is near, and a proxy would hide a silent link.
        return await connect(
            address.control_socket,
            proxy=None,
            compression=None,
            ping_interval=PING_S,
            ping_timeout=PING_TIMEOUT_S,
            close_timeout=CLOSE_S,
        )
    except InvalidStatus as error:
        raise SetupError(_why_refused(address, error.response.status_code)) from error
    except (OSError, InvalidHandshake) as error:
        raise SetupError(
            f"no robot is served at {address.page}; start one with `tapreach run`, or give the address that "
            f"it printed ({error})"
        ) from error


def _why_refused(address: ServerAddress, status: int) -> str:
    if status == 403:
        return (
            f"{address.page} lets nobody in without its token: give the address as `tapreach run` printed it"
        )
    return f"{address.page} is no tapreach server: it answers with {status}"


def _why_closed(error: ConnectionClosed) -> str:
    said = error.rcvd.reason if error.rcvd is not None else ""
    return f"the connection to the robot is gone: {said or error}"
