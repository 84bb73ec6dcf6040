"""Test pictures that carry their own number in a bar code, readable after JPEG, scaling and drawing.

Sixteen cells span the top sixteenth of the picture, white for 1: two for the start (10), nine for the code,
three that count its zeros modulo eight, two for the end (01). browser_probe.js reads the same in a page.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.pixel import ImageSize

CELLS = 16
CODE_BITS = 9
CODES = 2**CODE_BITS
"""Codes repeat after this many frames: 17 s at 30 frames per second."""
_START, _END = (1, 0), (0, 1)
_BRIGHT = 128
Picture = NDArray[np.uint8]


def bar_code(code: int) -> tuple[int, ...]:
    """Return the sixteen cells for `code` modulo CODES."""
    bits = tuple(code >> shift & 1 for shift in reversed(range(CODE_BITS)))
    zeros = bits.count(0) % 8
    return (*_START, *bits, *(zeros >> shift & 1 for shift in (2, 1, 0)), *_END)


def read_bar_code(picture: Picture) -> int | None:
    """Return the code in a picture, (height, width) or (height, width, 3); None when there is none."""
    height, width = picture.shape[:2]
    columns = ((np.arange(CELLS) + 0.5) * width / CELLS).astype(int)
    brightness = picture[height // 32, columns].reshape(CELLS, -1).mean(axis=1)
    cells = tuple(int(value > _BRIGHT) for value in brightness)
    code = int("".join(map(str, cells[2 : 2 + CODE_BITS])), 2)
    return code if cells == bar_code(code) else None


def pattern_jpegs(size: ImageSize, seed: int, count: int = CODES) -> list[bytes]:
    """Return `count` JPEGs with the codes 0, 1, ...: a moving texture of a camera picture's weight.

    About 44 kB at 640 x 480 (quality chosen to fit) and in proportion to the area at other sizes.
    """
    texture = _texture(size, np.random.default_rng(seed))
    wanted_bytes = 44_000 * size.width * size.height / (640 * 480)
    quality = min(range(30, 97, 2), key=lambda q: abs(len(_jpeg(texture, q)) - wanted_bytes))
    return [_jpeg(with_bar_code(np.roll(texture, 3 * code, axis=1), code), quality) for code in range(count)]


def with_bar_code(picture: Picture, code: int) -> Picture:
    """Return a copy of `picture` with the bar code over its top."""
    marked = picture.copy()
    edges = np.linspace(0, picture.shape[1], CELLS + 1).astype(int)
    for cell, left, right in zip(bar_code(code), edges[:-1], edges[1:], strict=True):
        marked[: picture.shape[0] // 16, left:right] = 235 if cell else 16
    return marked


def _texture(size: ImageSize, random: np.random.Generator) -> Picture:
    # Coarse shapes with fine grain on them compress like a camera's picture of a room.
    coarse = random.uniform(40, 215, (size.height // 40, size.width // 40, 3)).astype(np.float32)
    shapes = cv2.resize(coarse, (size.width, size.height), interpolation=cv2.INTER_CUBIC)
    grain = random.normal(0, 5, (size.height, size.width, 1)).astype(np.float32)
    return np.asarray(np.clip(shapes + grain, 0, 255), np.uint8)


def _jpeg(picture: Picture, quality: int) -> bytes:
    return bytes(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])[1])
