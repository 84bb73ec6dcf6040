"""Running the application: the listening socket, signals, and an end that leaves nothing behind."""

import asyncio
import contextlib
import signal
import socket
from collections.abc import Callable, Coroutine, Iterator
from typing import Any

import anyio.lowlevel
import uvicorn
import uvloop

from tapreach.errors import SetupError
from tapreach.server.access import AccessPolicy
from tapreach.server.app import create_app
from tapreach.server.station import Station

NOT_SENT_BYTES = 16_384
"""Kernel buffer behind which a slow viewer's frames wait: small, so that they are fresh when they leave."""
MOST_MESSAGE_BYTES = 1_000_000
"""Beyond this a WebSocket message closes its socket (1009); from 16 kB up it is refused with an answer."""
PING_S, PING_TIMEOUT_S = 5.0, 10.0
"""Long enough for a picture to pass a very slow link; what must be quick does not wait for this."""


def listening_socket(host: str, port: int) -> socket.socket:
    """Return a socket that listens; port 0 takes any free one. Raises SetupError where that cannot be."""
    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        # Accepted sockets inherit it; without it an answer after another waits 40 ms for a delayed ACK.
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if hasattr(socket, "TCP_NOTSENT_LOWAT"):
            # Inherited too.
            listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, NOT_SENT_BYTES)
        listener.bind((host, port))
        listener.listen(128)
    except OSError as error:
        listener.close()
        raise SetupError(
            f"cannot listen on {host} port {port}: {error.strerror}; choose another with --port"
        ) from error
    return listener


class _Server(uvicorn.Server):
    """uvicorn without its signal handlers, which would raise the signal again before we have cleaned up."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


def run_event_loop(main: Coroutine[Any, Any, None]) -> None:
    """Run the server's coroutine to its end on uvloop, which answers sooner than asyncio's own loop."""
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        runner.run(main)


async def serve(
    station: Station,
    listener: socket.socket,
    policy: AccessPolicy,
    on_ready: Callable[[], None] = lambda: None,
) -> None:
    """Start the station, serve until SIGINT or SIGTERM, stop everything.

    Raises what ended the control loop, when that is why it ends, and DriverError or SetupError of the robot.
    """
    config = uvicorn.Config(
        create_app(station, policy),
        lifespan="off",
        log_level="warning",
        access_log=False,
        ws_per_message_deflate=False,
        ws_max_size=MOST_MESSAGE_BYTES,
        ws_ping_interval=PING_S,
        ws_ping_timeout=PING_TIMEOUT_S,
        timeout_graceful_shutdown=1,
    )
    server = _Server(config)

    def end() -> None:
        station.prepare_end()
        server.should_exit = True

    with _signals_call(end):
        try:
            # Loads anyio's backend now, which would hold up the loop for 40 ms with the first request.
            await anyio.lowlevel.checkpoint()
            await station.start()
            await _serve_until_failure(server, station, listener, on_ready)
        finally:
            await station.stop()
            listener.close()


async def _serve_until_failure(
    server: _Server, station: Station, listener: socket.socket, on_ready: Callable[[], None]
) -> None:
    assert station.failed is not None
    serving = asyncio.create_task(server.serve(sockets=[listener]), name="http")
    try:
        on_ready()
        await asyncio.wait({serving, station.failed}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        station.prepare_end()
        server.should_exit = True
        await serving
    if station.failed.done():
        station.failed.result()


@contextlib.contextmanager
def _signals_call(callback: Callable[[], object]) -> Iterator[None]:
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, callback)
    try:
        yield
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.remove_signal_handler(number)
