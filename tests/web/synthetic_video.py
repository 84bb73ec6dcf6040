"""Pictures for page tests: a floor, a red can, and the frame's id written into the pixels."""

import json
import struct

import cv2
import numpy as np
from numpy.typing import NDArray

HEADER = struct.Struct("<4sIQQHHI")
ID_BITS = 16
BLOCK_PX = 16
Image = NDArray[np.uint8]


def room(width: int = 640, height: int = 480) -> Image:
    """Return a plain room in BGR, (height, width, 3)."""
    v, u = np.mgrid[0:height, 0:width].astype(np.float64)
    horizon = 0.22 * height
    depth = 60.0 / np.maximum(v - horizon, 1.0)
    column = np.floor((u - width / 2) * depth / 22.0) + np.floor(18.0 * depth)
    floor = np.where((column % 2 == 0)[..., None], (92, 128, 160), (84, 118, 148)).astype(np.float64)
    wall = np.full_like(floor, (150, 152, 148))
    picture = np.where((v < horizon)[..., None], wall, floor * (0.65 + 0.35 * v / height)[..., None])
    image = picture.astype(np.uint8)
    cv2.rectangle(
        image, (width // 2 + 40, height // 4), (width // 2 + 100, height // 2 + 20), (40, 36, 200), -1
    )
    cv2.ellipse(image, (width // 2 + 70, height // 4), (30, 9), 0, 0, 360, (200, 205, 215), -1)
    return image


def stamped_jpeg(background: Image, frame_id: int) -> bytes:
    """Return the picture as JPEG, the low bits of `frame_id` as black and white blocks at the top left."""
    image = background.copy()
    for bit in range(ID_BITS):
        value = 255 if frame_id >> bit & 1 else 0
        image[:BLOCK_PX, bit * BLOCK_PX : (bit + 1) * BLOCK_PX] = value
    return cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 85])[1].tobytes()


def video_message(
    frame_id: int,
    captured_ns: int,
    jpeg: bytes,
    size: tuple[int, int],
    markers: list[object],
    base: tuple[float, float, float] = (0.0, 0.0, 0.0),
    path: list[object] | None = None,
) -> bytes:
    """Return a message of the video socket."""
    meta = json.dumps({"base": base, "markers": markers} | ({"path": path} if path else {})).encode()
    header = HEADER.pack(b"TRV1", frame_id, captured_ns, captured_ns, size[0], size[1], len(meta))
    return header + meta + jpeg
