"""Pictures out of multipart/x-mixed-replace, whose bytes come in pieces of any size (RFC 2046, 5.1)."""

from dataclasses import dataclass

from tapreach.drivers.camera.jpeg import BrokenJpeg, JpegWalk
from tapreach.geometry.pixel import ImageSize

MOST_HEADER_BYTES = 8192
MOST_JPEG_BYTES = 16 << 20


@dataclass(frozen=True, slots=True)
class Part:
    """A part of the stream: its headers, names in lower case, and a whole JPEG."""

    headers: dict[str, str]
    jpeg: bytes
    size: ImageSize


class MultipartParser:
    """Takes the bytes of the stream, gives the JPEGs.

    A picture ends where the JPEG itself does, so it is there with its last byte, whether its length was
    announced, was announced wrongly, or not at all. What is no whole JPEG is counted and skipped: the next
    delimiter begins a new part.
    """

    def __init__(self, boundary: str) -> None:
        # Some cameras put the two dashes of the delimiter into the parameter, some do not.
        self._delimiter = b"--" + boundary.lstrip("-").encode("latin-1")
        self._buffer = bytearray()
        self._headers: dict[str, str] | None = None
        self._walk: JpegWalk | None = None
        self.skipped = 0
        """Parts that were no whole JPEG."""

    def feed(self, data: bytes) -> list[Part]:
        """Take more bytes and return the pictures that are complete now, oldest first."""
        self._buffer += data
        parts: list[Part] = []
        while self._advance(parts):
            pass
        return parts

    def _advance(self, parts: list[Part]) -> bool:
        """Go one step; False when it takes more bytes."""
        if self._headers is None:
            return self._take_headers()
        if self._walk is None:
            self._walk = JpegWalk()
        try:
            length = self._walk.advance(self._buffer)
            if length is None and len(self._buffer) > MOST_JPEG_BYTES:
                raise BrokenJpeg(f"more than {MOST_JPEG_BYTES} bytes")
        except BrokenJpeg:
            self.skipped += 1
            self._leave_part()
            return True
        if length is None or self._walk.size is None:
            return False
        parts.append(Part(self._headers, bytes(self._buffer[:length]), self._walk.size))
        del self._buffer[:length]
        self._leave_part()
        return True

    def _leave_part(self) -> None:
        self._headers = self._walk = None

    def _take_headers(self) -> bool:
        at = self._buffer.find(self._delimiter)
        if at < 0:
            # The delimiter may have begun with the last bytes.
            del self._buffer[: max(0, len(self._buffer) - len(self._delimiter) + 1)]
            return False
        begin = at + len(self._delimiter)
        end, after = _end_of_headers(self._buffer, begin)
        if end < 0:
            if len(self._buffer) - begin > MOST_HEADER_BYTES:
                self.skipped += 1
                del self._buffer[:begin]
                return True
            del self._buffer[:at]
            return False
        self._headers = _parse_headers(bytes(self._buffer[begin:end]))
        del self._buffer[:after]
        return True


def _end_of_headers(buffer: bytearray, begin: int) -> tuple[int, int]:
    """Return where the headers end and where the body begins, or -1 twice; bare LF is taken as well."""
    ends = [
        (at, at + len(blank)) for blank in (b"\r\n\r\n", b"\n\n") if (at := buffer.find(blank, begin)) >= 0
    ]
    return min(ends, default=(-1, -1))


def _parse_headers(text: bytes) -> dict[str, str]:
    headers = {}
    for line in text.decode("latin-1").splitlines():
        name, colon, value = line.partition(":")
        if colon:
            headers[name.strip().lower()] = value.strip()
    return headers
