"""A slow network on loopback: a TCP proxy that passes a given number of bytes per second to its client."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator

from tapreach.robot.clock import SECOND, Clock

_CHUNK = 2048
_BUFFER = 8192
_WAITING_CHUNKS = 4
# Small buffers on both sides: what waits must wait in the sender, as before a slow modem with a short queue.


@contextlib.asynccontextmanager
async def narrow_link(target_port: int, bytes_per_second: float, clock: Clock) -> AsyncIterator[int]:
    """Yield a port that leads to `target_port`; answers pass at `bytes_per_second`, requests freely."""
    busy: set[asyncio.Task[None]] = set()

    async def serve(client_in: asyncio.StreamReader, client_out: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        busy.add(task)
        # Cancelled at the end of the block: asyncio's streams would print it as an error.
        with contextlib.suppress(ConnectionError, asyncio.CancelledError):
            await _join(client_in, client_out, target_port, bytes_per_second, clock)
        busy.discard(task)

    server = await asyncio.start_server(serve, "127.0.0.1", 0, limit=_BUFFER)
    try:
        yield server.sockets[0].getsockname()[1]
    finally:
        server.close()
        for task in tuple(busy):
            task.cancel()
        await asyncio.gather(*busy, return_exceptions=True)


async def _join(
    client_in: asyncio.StreamReader,
    client_out: asyncio.StreamWriter,
    target_port: int,
    bytes_per_second: float,
    clock: Clock,
) -> None:
    upstream = socket.socket()
    upstream.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)  # before connect: it sets the window
    upstream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    upstream.setblocking(False)
    await asyncio.get_running_loop().sock_connect(upstream, ("127.0.0.1", target_port))
    server_in, server_out = await asyncio.open_connection(sock=upstream, limit=_BUFFER)
    up = asyncio.create_task(_pass_freely(client_in, server_out))
    down = asyncio.create_task(_pass_slowly(server_in, client_out, bytes_per_second, clock))
    try:
        await asyncio.wait((up, down), return_when=asyncio.FIRST_COMPLETED)
    finally:
        up.cancel()
        down.cancel()
        await asyncio.gather(up, down, return_exceptions=True)
        server_out.close()
        client_out.close()


async def _pass_freely(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
    while data := await source.read(_CHUNK):
        sink.write(data)
        await sink.drain()


async def _pass_slowly(
    source: asyncio.StreamReader, sink: asyncio.StreamWriter, bytes_per_second: float, clock: Clock
) -> None:
    # Stamped on arrival: when this process is scheduled late, the line was busy all the same and catches up.
    arrived: asyncio.Queue[tuple[int, bytes]] = asyncio.Queue(_WAITING_CHUNKS)
    stamping = asyncio.create_task(_stamp(source, arrived, clock))
    free_ns = 0
    try:
        while True:
            arrived_ns, data = await arrived.get()
            if not data:
                return
            # A chunk arrives when its last byte does, and the line is busy until then.
            free_ns = max(free_ns, arrived_ns) + round(len(data) / bytes_per_second * SECOND)
            await clock.sleep_until(free_ns)
            sink.write(data)
            await sink.drain()
    finally:
        stamping.cancel()


async def _stamp(
    source: asyncio.StreamReader, arrived: "asyncio.Queue[tuple[int, bytes]]", clock: Clock
) -> None:
    data = b"-"
    while data:
        data = await source.read(_CHUNK)
        await arrived.put((clock.now_ns(), data))
