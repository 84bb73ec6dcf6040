"""The peer: an ordinary MJPEG stream as small camera servers send it, shown by a plain <img>.

Each part is headers, picture, boundary, and nothing of the next part is sent ahead. A browser shows a part
when it sees the next one begin, so it shows every picture one frame late: that is what is to be beaten.
"""

import argparse
import asyncio
import contextlib
import json

from tapreach.bench.child import stdin_lines, tell_parent
from tapreach.bench.pattern import pattern_jpegs
from tapreach.bench.pattern_description import pattern_description
from tapreach.bench.pattern_robot import PatternRobot
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import Clock, MonotonicClock
from tapreach.robot.messages import Frame

_PAGE = b"<!doctype html><title>peer</title><body></body>"
_STREAM_HEAD = (
    b"HTTP/1.1 200 OK\r\nCache-Control: no-store\r\n"
    b"Content-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n"
)


class MjpegPeer:
    """Serves `/` (an empty page), `/stream.mjpg`, and `/captured.json` (capture time of each frame id)."""

    def __init__(self) -> None:
        self._captured_ns: list[int] = [0]
        self._newest: Frame | None = None
        self._changed = asyncio.Event()

    def on_frame(self, frame: Frame) -> None:
        """Take the newest picture."""
        self._newest = frame
        self._captured_ns.append(frame.captured_ns)
        self._changed.set()
        self._changed = asyncio.Event()

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer one request."""
        # Cancelled at the end of the bench: asyncio's streams would print it as an error.
        with contextlib.suppress(ConnectionError, asyncio.IncompleteReadError, asyncio.CancelledError):
            path = (await reader.readuntil(b"\r\n\r\n")).split(b" ", 2)[1]
            if path == b"/stream.mjpg":
                await self._stream(writer)
            elif path == b"/captured.json":
                await _answer(writer, b"application/json", json.dumps(self._captured_ns).encode())
            else:
                await _answer(writer, b"text/html", _PAGE)
        writer.close()

    async def _stream(self, writer: asyncio.StreamWriter) -> None:
        writer.write(_STREAM_HEAD)
        while True:
            await self._changed.wait()
            assert self._newest is not None
            jpeg = self._newest.jpeg
            head = b"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n" % len(jpeg)
            writer.write(head + jpeg + b"\r\n")
            await writer.drain()


async def _answer(writer: asyncio.StreamWriter, kind: bytes, body: bytes) -> None:
    head = b"HTTP/1.1 200 OK\r\nContent-Type: %s\r\nContent-Length: %d\r\nConnection: close\r\n\r\n"
    writer.write(head % (kind, len(body)) + body)
    await writer.drain()


async def _run(size: ImageSize, rate_hz: float, seed: int, clock: Clock) -> None:
    peer = MjpegPeer()
    robot = PatternRobot(pattern_description(size, rate_hz), pattern_jpegs(size, seed), clock, lambda _: None)
    robot.frames.subscribe(peer.on_frame)
    server = await asyncio.start_server(peer.serve, "127.0.0.1", 0)
    await robot.connect()
    tell_parent({"port": server.sockets[0].getsockname()[1]})
    async for _ in stdin_lines():
        pass
    await robot.close()
    server.close()


def main() -> None:
    """Serve until stdin closes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("width", type=int)
    parser.add_argument("height", type=int)
    parser.add_argument("rate_hz", type=float)
    parser.add_argument("seed", type=int)
    given = parser.parse_args()
    asyncio.run(_run(ImageSize(given.width, given.height), given.rate_hz, given.seed, MonotonicClock()))


if __name__ == "__main__":
    main()
