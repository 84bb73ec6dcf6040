"""JPEG bytes to grey pictures. A broken picture is a result, not an exception: cameras do drop bytes."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Gray = NDArray[np.uint8]
"""(height, width), indexed [v, u]."""

Color = NDArray[np.uint8]
"""(height, width, 3), indexed [v, u], blue, green, red (OpenCV)."""

_START = b"\xff\xd8"
_END = b"\xff\xd9"


@dataclass(frozen=True, slots=True)
class BrokenPicture:
    """Bytes that do not hold a whole picture, and why."""

    reason: str


def decode_gray(jpeg: bytes) -> Gray | BrokenPicture:
    """Return the grey picture of a JPEG, or BrokenPicture for bytes that are not one, or not all of one.

    A JPEG that was cut short is refused: decoders fill the missing part with grey, which a tracker would
    follow.
    """
    return _decoded(jpeg, cv2.IMREAD_GRAYSCALE)


def decode_color(jpeg: bytes) -> Color | BrokenPicture:
    """Return the picture of a JPEG in colour; BrokenPicture as `decode_gray`."""
    return _decoded(jpeg, cv2.IMREAD_COLOR)


def _decoded(jpeg: bytes, how: int) -> NDArray[np.uint8] | BrokenPicture:
    if not jpeg.startswith(_START):
        return BrokenPicture(f"{len(jpeg)} bytes that do not begin like a JPEG")
    if _END not in jpeg[-64:]:
        return BrokenPicture(f"a JPEG of {len(jpeg)} bytes that was cut short")
    try:
        picture = cv2.imdecode(np.frombuffer(jpeg, dtype=np.uint8), how)
    except cv2.error as error:
        return BrokenPicture(f"a JPEG that cannot be decoded ({error.err})")
    if picture is None:
        return BrokenPicture(f"a JPEG of {len(jpeg)} bytes that cannot be decoded")
    return np.asarray(picture, dtype=np.uint8)
