"""JPEGs of drawn pictures: each seed another one, so that a test can tell which one arrived."""

import cv2
import numpy as np

SIZE = (160, 120)


def jpeg(seed: int, width: int = SIZE[0], height: int = SIZE[1], quality: int = 80) -> bytes:
    rng = np.random.default_rng(seed)
    small = rng.integers(0, 256, (height // 8, width // 8, 3), dtype=np.uint8)
    picture = cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC)
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()


def part(data: bytes, boundary: str = "frame", extra: str = "", with_length: bool = True) -> bytes:
    length = f"Content-Length: {len(data)}\r\n" if with_length else ""
    head = f"--{boundary}\r\nContent-Type: image/jpeg\r\n{length}{extra}\r\n"
    return head.encode() + data + b"\r\n"
