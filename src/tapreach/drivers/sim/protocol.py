"""What host and simulator say to each other: plain values, one JSON array per packet, defined here only.

Two socket pairs join them. The control pair (SOCK_SEQPACKET: one packet, one message) carries everything
below; the frame pair (SOCK_STREAM) carries pictures, each a header and a JPEG.
"""

import json
import struct
from dataclasses import astuple, dataclass, fields

from tapreach.errors import DriverError

MAX_PACKET = 1 << 18
FRAME_HEADER = struct.Struct("<4sIqq")
FRAME_MAGIC = b"TRF1"
MAX_JPEG = 1 << 24


@dataclass(frozen=True, slots=True)
class Setup:
    """First word of the host: JSON of scene, robot description and faults."""

    scene: str
    description: str
    faults: str
    seed: int
    opengl: str
    tells_truth: bool


@dataclass(frozen=True, slots=True)
class Drive:
    """Twist [m/s, rad/s]."""

    linear: float
    angular: float


@dataclass(frozen=True, slots=True)
class MoveArm:
    """Arm target [rad, m]."""

    rotation: float
    shoulder: float
    elbow: float
    claw: float


@dataclass(frozen=True, slots=True)
class AskTruth:
    """Where everything truly was at a time [ns], 0 for now. Answered only when setup asked for it."""

    at_ns: int


@dataclass(frozen=True, slots=True)
class Ready:
    """The simulator runs; name of the OpenGL way."""

    opengl: str


@dataclass(frozen=True, slots=True)
class Failed:
    """The simulator cannot go on: class name of the error, and the sentence."""

    kind: str
    reason: str


@dataclass(frozen=True, slots=True)
class Telemetry:
    """State of the board. Ticks of both wheels; arm as sent and as asked [rad, m]."""

    captured_ns: int
    left_ticks: int
    right_ticks: int
    rotation: float
    shoulder: float
    elbow: float
    claw: float
    target_rotation: float
    target_shoulder: float
    target_elbow: float
    target_claw: float
    arm_is_moving: bool
    needs_zero: bool


@dataclass(frozen=True, slots=True)
class TruthReply:
    """JSON of a truth.WorldTruth."""

    truth: str


Message = Setup | Drive | MoveArm | AskTruth | Ready | Failed | Telemetry | TruthReply
_KINDS = {
    kind.__name__: kind for kind in (Setup, Drive, MoveArm, AskTruth, Ready, Failed, Telemetry, TruthReply)
}


def encode(message: Message) -> bytes:
    """Return one packet."""
    return json.dumps([type(message).__name__, *astuple(message)]).encode()


def decode(packet: bytes) -> Message:
    """Return the message of a packet. Raises DriverError for anything else, naming what came."""
    try:
        name, *values = json.loads(packet)
        kind = _KINDS[name]
    except (ValueError, KeyError, TypeError):
        raise DriverError(
            f"not a message of the simulator: {packet[:60]!r}; known: {', '.join(_KINDS)}"
        ) from None
    if len(values) != len(fields(kind)):
        raise DriverError(f"{name} has {len(values)} values, it must have {len(fields(kind))}")
    return kind(*values)


def encode_frame(captured_ns: int, leaves_ns: int, jpeg: bytes) -> bytes:
    """Return header and JPEG."""
    return FRAME_HEADER.pack(FRAME_MAGIC, len(jpeg), captured_ns, leaves_ns) + jpeg


class FrameParser:
    """Cuts a byte stream into pictures, however it is split."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Take bytes and return the pictures completed by them: (captured_ns, jpeg). Raises DriverError."""
        self._buffer += data
        frames = []
        while len(self._buffer) >= FRAME_HEADER.size:
            magic, size, captured_ns, _ = FRAME_HEADER.unpack_from(self._buffer)
            if magic != FRAME_MAGIC or size > MAX_JPEG:
                raise DriverError(f"the picture stream is broken: header begins with {magic!r}")
            end = FRAME_HEADER.size + size
            if len(self._buffer) < end:
                break
            frames.append((captured_ns, bytes(self._buffer[FRAME_HEADER.size : end])))
            del self._buffer[:end]
        return frames
