"""A server on loopback that sends what a test tells it to, byte by byte where wanted."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress

Answer = Callable[["Visit"], Awaitable[None]]
OK = b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=frame\r\n\r\n"


class Visit:
    """One request and the way to answer it."""

    def __init__(self, number: int, request: str, writer: asyncio.StreamWriter) -> None:
        self.number, self.request, self._writer = number, request, writer

    async def send(self, data: bytes) -> None:
        self._writer.write(data)
        await self._writer.drain()

    def reset(self) -> None:
        self._writer.transport.abort()


class MjpegServer:
    """Counts visits; `answer` is called for each, and the connection is closed after it."""

    def __init__(self, answer: Answer) -> None:
        self.answer = answer
        self.visits: list[Visit] = []
        self.open_connections = 0
        self.port = 0

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/?action=stream"

    @asynccontextmanager
    async def running(self) -> AsyncIterator["MjpegServer"]:
        server = await asyncio.start_server(self._visit, "127.0.0.1", self.port)
        self.port = server.sockets[0].getsockname()[1]
        try:
            yield self
        finally:
            server.close()

    async def _visit(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.open_connections += 1
        with suppress(ConnectionError, asyncio.IncompleteReadError):
            request = (await reader.readuntil(b"\r\n\r\n")).decode()
            visit = Visit(len(self.visits) + 1, request, writer)
            self.visits.append(visit)
            answering = asyncio.ensure_future(self.answer(visit))
            leaving = asyncio.ensure_future(reader.read())
            await asyncio.wait({answering, leaving}, return_when=asyncio.FIRST_COMPLETED)
            leaving.cancel()
            if not answering.done():
                answering.cancel()
            with suppress(asyncio.CancelledError, ConnectionError):
                await answering
        writer.close()
        self.open_connections -= 1
