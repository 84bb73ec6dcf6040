"""Messages to bytes and back: frames are written whole and read out of whatever the line brings."""

from dataclasses import dataclass
from struct import error

from tapreach.drivers.arduino.framing import FrameSplitter, frame, unframe
from tapreach.drivers.arduino.wire import MESSAGES, Message
from tapreach.errors import InputError


@dataclass(frozen=True)
class Received:
    """A message with its sequence number."""

    seq: int
    message: Message


def encode(message: Message, seq: int) -> bytes:
    """Return the frame of a message, zeros included; seq is taken modulo 256.

    Raises InputError for a value that does not fit its field.
    """
    try:
        body = message.pack()
    except error as problem:
        raise InputError(f"{message} cannot be sent: {problem}") from None
    return frame(bytes([message.TYPE, seq & 0xFF]) + body)


def decode(payload: bytes) -> Received | None:
    """Return the message of a payload; None for an unknown type, a wrong length or an unknown value."""
    kind = MESSAGES.get(payload[0]) if len(payload) >= 2 else None
    if kind is None or len(payload) != 2 + kind.FORMAT.size:
        return None
    try:
        return Received(payload[1], kind.unpack(payload[2:]))
    except ValueError:
        return None


class FrameReader:
    """Messages out of a stream of bytes, whatever stands between them; after garbage, from the next zero."""

    def __init__(self) -> None:
        self._splitter = FrameSplitter()
        self.good_frames = 0
        self.bad_frames = 0

    def feed(self, data: bytes) -> list[Received]:
        """Return the messages that are now complete. Never raises; what is no message is counted."""
        payloads = [unframe(coded) for coded in self._splitter.feed(data)]
        read = [decode(payload) if payload is not None else None for payload in payloads]
        found = [received for received in read if received is not None]
        self.good_frames += len(found)
        self.bad_frames += len(read) - len(found)
        return found
