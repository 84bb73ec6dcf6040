"""A frame on its way to the viewers: header, meta, JPEG; encoded once per quality for all of them.

Layout, little-endian: magic "TRV1", frame_id u32, captured_ns u64, sent_ns u64, width u16, height u16,
meta_length u32; then `meta_length` bytes of JSON (UTF-8); then the JPEG.
"""

import asyncio
import struct
from dataclasses import dataclass

import cv2
import numpy as np

from tapreach.geometry.pixel import ImageSize
from tapreach.robot.messages import Frame

HEADER = struct.Struct("<4sIQQHHI")
MAGIC = b"TRV1"


@dataclass(frozen=True, slots=True)
class Quality:
    """A step of the ladder; None passes the camera's own JPEG through."""

    jpeg_quality: int | None
    shrink: int = 1


LADDER = (Quality(None), Quality(50), Quality(30, shrink=2))
"""From best to smallest."""


@dataclass(frozen=True, slots=True)
class Encoded:
    """A frame at one quality: meta and JPEG, ready to follow a header."""

    frame_id: int
    captured_ns: int
    size: ImageSize
    meta: bytes
    jpeg: bytes

    def message(self, sent_ns: int) -> bytes:
        """Return the whole binary message."""
        header = HEADER.pack(
            MAGIC,
            self.frame_id,
            self.captured_ns,
            sent_ns,
            self.size.width,
            self.size.height,
            len(self.meta),
        )
        return b"".join((header, self.meta, self.jpeg))


class FramePacket:
    """A frame, its meta, and its encodings as viewers ask for them."""

    def __init__(self, frame: Frame, meta: bytes) -> None:
        self.frame = frame
        self._meta = meta
        self._encodings: dict[int, asyncio.Task[Encoded]] = {}

    async def encoded(self, level: int) -> Encoded:
        """Return the frame at LADDER[level]; encoding happens once, in a thread."""
        if LADDER[level].jpeg_quality is None:
            return self._with(self.frame.size, self.frame.jpeg)
        if level not in self._encodings:
            self._encodings[level] = asyncio.create_task(self._encode(LADDER[level]))
        # One viewer that leaves must not take the encoding away from the others.
        return await asyncio.shield(self._encodings[level])

    async def _encode(self, quality: Quality) -> Encoded:
        size, jpeg = await asyncio.to_thread(reencoded, self.frame.jpeg, quality)
        return self._with(size, jpeg)

    def _with(self, size: ImageSize, jpeg: bytes) -> Encoded:
        return Encoded(self.frame.frame_id, self.frame.captured_ns, size, self._meta, jpeg)


def reencoded(jpeg: bytes, quality: Quality) -> tuple[ImageSize, bytes]:
    """Return size and JPEG of a picture made smaller."""
    picture = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None and quality.jpeg_quality is not None
    if quality.shrink > 1:
        height, width = picture.shape[:2]
        smaller = (width // quality.shrink, height // quality.shrink)
        picture = cv2.resize(picture, smaller, interpolation=cv2.INTER_AREA)
    _, encoded = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality.jpeg_quality])
    return ImageSize(picture.shape[1], picture.shape[0]), encoded.tobytes()
