"""MJPEG over HTTP, as mjpg-streamer, ustreamer and most network cameras give it."""

import select
import socket
from base64 import b64encode
from contextlib import suppress
from email.message import Message
from http.client import HTTPConnection, HTTPException, HTTPResponse
from urllib.parse import SplitResult, unquote, urlsplit

from tapreach.drivers.camera.lag import Lag
from tapreach.drivers.camera.multipart import MultipartParser, Part
from tapreach.drivers.camera.stream import OPEN_S, STALL_S, Picture
from tapreach.errors import DriverError
from tapreach.robot.camera_source import CameraSource
from tapreach.robot.clock import SECOND, Clock

PIECE = 1 << 16
MOST_AT_ONCE = 4 << 20
"""A sender faster than we read must not keep us from telling."""


class MjpegStream:
    """See Stream. The JPEGs pass untouched; a picture was taken `delay_ns` before its last byte arrived.

    Where the sender stamps its pictures (X-Timestamp), what a picture is late by is taken off as well, so
    that one which waited in a buffer on the way is known to be old.
    """

    def __init__(self, source: CameraSource, clock: Clock, delay_ns: int) -> None:
        self._source, self._clock, self._delay_ns = source, clock, delay_ns
        self._connection: HTTPConnection | None = None
        self._response: HTTPResponse | None = None
        self._socket: socket.socket | None = None
        self._poll = select.poll()
        self._parser = MultipartParser("")
        self._lag = Lag()
        self._is_interrupted = False

    @property
    def skipped(self) -> int:
        """See Stream."""
        return self._parser.skipped

    def open(self) -> None:
        """See Stream."""
        url = urlsplit(self._source.address)
        self._connection = HTTPConnection(url.hostname or "", url.port or 80, timeout=OPEN_S)
        try:
            self._connection.connect()
            self._socket = self._connection.sock
            if self._is_interrupted:
                raise DriverError("closed")
            self._connection.request("GET", _target(url), headers=_headers(url))
            self._response = self._connection.getresponse()
        except (OSError, HTTPException, ValueError) as error:
            raise DriverError(f"{self._source.label} does not answer: {_said(error)}") from None
        self._parser = MultipartParser(self._boundary(self._response))
        self._socket.settimeout(STALL_S)
        self._poll.register(self._socket, select.POLLIN)

    def read(self) -> Picture:
        """See Stream."""
        end_ns = self._clock.now_ns() + round(STALL_S * SECOND)
        while self._clock.now_ns() < end_ns:
            parts = self._receive()
            if parts:
                return self._picture(parts[-1])
        raise DriverError(f"{self._source.label} has sent no picture for {STALL_S:.0f} s")

    def interrupt(self) -> None:
        """See Stream."""
        self._is_interrupted = True
        if self._socket is not None:
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """See Stream."""
        for opened in (self._response, self._connection):
            if opened is not None:
                with suppress(OSError, HTTPException):
                    opened.close()

    def _receive(self) -> list[Part]:
        """Wait for bytes, take all that are there and return the pictures in them."""
        assert self._response is not None
        parts: list[Part] = []
        taken = 0
        while taken < MOST_AT_ONCE:
            try:
                data = self._response.read1(PIECE)
            except (OSError, HTTPException, ValueError) as error:
                raise DriverError(f"{self._source.label} broke off: {_said(error)}") from None
            if not data:
                raise DriverError(f"{self._source.label} has ended the stream")
            taken += len(data)
            parts += self._parser.feed(data)
            if not self._poll.poll(0):
                break
        return parts

    def _picture(self, part: Part) -> Picture:
        if part.headers.get("x-ustreamer-online", "").lower() == "false":
            raise DriverError(f"{self._source.label} says that it has no picture of its camera")
        now_ns = self._clock.now_ns()
        stamp_ns = _stamp_ns(part.headers.get("x-timestamp", ""))
        late_ns = 0 if stamp_ns is None else self._lag.of(now_ns, stamp_ns)
        return Picture(now_ns - self._delay_ns - late_ns, now_ns, part.size, part.jpeg)

    def _boundary(self, response: HTTPResponse) -> str:
        label, kind = self._source.label, response.headers.get_content_type()
        if response.status != 200:
            where = response.headers.get("Location")
            to = f", to {where}" if where else ""
            raise DriverError(f"{label} answers {response.status} {response.reason}{to}; 200 would be right")
        boundary = response.headers.get_param("boundary")
        if kind != "multipart/x-mixed-replace" or not isinstance(boundary, str) or not boundary.strip("-"):
            raise DriverError(
                f"{label} sends {_shown(response.headers)}, no MJPEG stream; multipart/x-mixed-replace with "
                "a boundary would be right (mjpg-streamer: /?action=stream, ustreamer: /stream)"
            )
        return boundary


def _shown(headers: Message) -> str:
    return str(headers.get("Content-Type", "no content type"))[:100]


def _target(url: SplitResult) -> str:
    return (url.path or "/") + (f"?{url.query}" if url.query else "")


def _headers(url: SplitResult) -> dict[str, str]:
    if url.username is None:
        return {}
    secret = f"{unquote(url.username)}:{unquote(url.password or '')}"
    return {"Authorization": "Basic " + b64encode(secret.encode()).decode()}


def _stamp_ns(text: str) -> int | None:
    """Return seconds as mjpg-streamer and ustreamer write them, in ns, or None where there are none."""
    try:
        stamp_ns = round(float(text) * SECOND)
    except (ValueError, OverflowError):
        return None
    return stamp_ns if stamp_ns > 0 else None


def _said(error: Exception) -> str:
    return f"nothing came in time ({error})" if isinstance(error, TimeoutError) else str(error) or repr(error)
