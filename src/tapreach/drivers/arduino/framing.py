"""Frames on a serial line: payload and CRC in COBS, between zeros.

COBS: Cheshire and Baker, "Consistent Overhead Byte Stuffing", 1999. CRC-16/CCITT-FALSE: polynomial 0x1021,
initial value 0xFFFF, not reflected.
"""

from binascii import crc_hqx

from tapreach.errors import InputError

LONGEST_FRAME = 64
"""Bytes between two zeros; also the bound of what a reader keeps of an unfinished frame."""


def crc16(payload: bytes) -> int:
    """Return the CRC-16/CCITT-FALSE of a payload; of b"123456789" it is 0x29B1."""
    return crc_hqx(payload, 0xFFFF)


def cobs_encode(data: bytes) -> bytes:
    """Return data without zeros, one byte longer. For data of at most 253 bytes, as all frames are."""
    pieces = data.split(b"\0")
    return b"".join(bytes([len(piece) + 1]) + piece for piece in pieces)


def cobs_decode(coded: bytes) -> bytes | None:
    """Return what was encoded, or None for bytes that no encoder makes."""
    pieces, at = [], 0
    while at < len(coded):
        end = at + coded[at]
        if coded[at] == 0 or end > len(coded):
            return None
        pieces.append(coded[at + 1 : end])
        at = end
    data = b"\0".join(pieces)
    return None if b"\0" in coded or not pieces else data


def frame(payload: bytes) -> bytes:
    """Return the frame of a payload, both zeros included. Raises InputError for one that is too long."""
    coded = cobs_encode(payload + crc16(payload).to_bytes(2, "little"))
    if len(coded) > LONGEST_FRAME:
        raise InputError(f"a payload of {len(payload)} bytes is too long; at most {LONGEST_FRAME - 3} fit")
    return b"\0" + coded + b"\0"


def unframe(coded: bytes) -> bytes | None:
    """Return the payload of what stood between two zeros, or None where it is not a whole frame."""
    data = cobs_decode(coded) if len(coded) <= LONGEST_FRAME else None
    if data is None or len(data) < 4 or crc16(data[:-2]) != int.from_bytes(data[-2:], "little"):
        return None
    return data[:-2]


class FrameSplitter:
    """Cuts a stream of bytes at its zeros. Keeps no more than one frame of what is unfinished."""

    def __init__(self) -> None:
        self._kept = bytearray()

    def feed(self, data: bytes) -> list[bytes]:
        """Return what now stands between zeros, never empty; too long pieces come back cut, and invalid."""
        found = []
        *finished, rest = data.split(b"\0")
        for piece in finished:
            self._keep(piece)
            if self._kept:
                found.append(bytes(self._kept))
            self._kept.clear()
        self._keep(rest)
        return found

    def _keep(self, piece: bytes) -> None:
        # One byte more than the longest frame marks what is too long, however much of it comes.
        self._kept += piece[: LONGEST_FRAME + 1 - len(self._kept)]
