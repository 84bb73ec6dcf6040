"""Where pictures come from, as a robot file names it: v4l2:/dev/video0, or an address of http or rtsp."""

from dataclasses import dataclass
from enum import StrEnum
from urllib.parse import SplitResult, urlsplit

from tapreach.errors import InputError

KNOWN_SOURCES = (
    '"v4l2:/dev/video0", "http://robot.example:8080/stream" (MJPEG) or "rtsp://robot.example/live"'
)


class SourceKind(StrEnum):
    """The ways a picture reaches the host."""

    V4L2 = "v4l2"
    HTTP = "http"
    RTSP = "rtsp"


@dataclass(frozen=True, slots=True)
class CameraSource:
    """A camera's kind and address: a device path, or a whole URL (it may hold a password: show `label`)."""

    kind: SourceKind
    address: str

    @property
    def label(self) -> str:
        """The address as people may see it, without user and password."""
        if self.kind is SourceKind.V4L2:
            return self.address
        parts = urlsplit(self.address)
        return parts._replace(netloc=parts.netloc.rpartition("@")[2]).geturl()


def parse_source(text: str) -> CameraSource:
    """Return the source that `text` names. Raises InputError that lists the known kinds."""
    kind, colon, rest = text.partition(":")
    if not colon or kind not in set(SourceKind) or text != text.strip():
        raise InputError(f"no camera source: {text!r}; known are {KNOWN_SOURCES}")
    if kind == SourceKind.V4L2:
        if not rest.startswith("/") or rest.endswith("/"):
            raise InputError(f"a v4l2 source names a device file, as v4l2:/dev/video0, not {text!r}")
        return CameraSource(SourceKind.V4L2, rest)
    _check_url(text)
    return CameraSource(SourceKind(kind), text)


def _check_url(text: str) -> None:
    fault = ""
    try:
        parts: SplitResult | None = urlsplit(text)
        port = parts.port if parts is not None else None
    except ValueError as error:
        parts, port, fault = None, None, str(error)
    if any(ord(letter) <= 0x20 or ord(letter) == 0x7F for letter in text):
        fault = "blanks and control characters have to be written as %20 and the like"
    elif parts is not None and (not parts.hostname or not text.partition(":")[2].startswith("//")):
        fault = "the host is missing"
    elif port == 0:
        fault = "port 0"
    if fault:
        raise InputError(f"camera source {text!r} cannot be used: {fault}; known are {KNOWN_SOURCES}")
