"""Strips of pictures with words above them, one for each run that went wrong, and a sheet of all."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.geometry.finite import FloatArray

Picture = NDArray[np.uint8]

RED, GREEN = (60, 60, 255), (80, 255, 80)
_INK = (255, 255, 255)
_COLUMNS, _MOST = 3, 60
_RADIUS = 11
_WIDTH, _LINE, _LETTERS = 560, 15, 95


def decoded(jpeg: bytes) -> Picture:
    """Return a JPEG or PNG in colour."""
    return np.asarray(cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR), np.uint8)


def ring(picture: Picture, pixel: FloatArray, colour: tuple[int, int, int]) -> None:
    """Draw a ring with a white rim around a place (2,) [px], unless it is far outside."""
    if np.all(np.abs(pixel) < 1e4):
        middle = round(float(pixel[0])), round(float(pixel[1]))
        cv2.circle(picture, middle, _RADIUS, _INK, 5, cv2.LINE_AA)
        cv2.circle(picture, middle, _RADIUS, colour, 2, cv2.LINE_AA)


def write_strip(path: Path, pictures: Sequence[Picture], lines: Sequence[str]) -> None:
    """Write pictures of one size side by side under lines of text (95 letters of each), making the folder."""
    side_by_side = np.hstack(pictures)
    height = _WIDTH * side_by_side.shape[0] // side_by_side.shape[1]
    strip = cv2.resize(side_by_side, (_WIDTH, height), interpolation=cv2.INTER_AREA)
    words = np.zeros((_LINE * len(lines) + 4, _WIDTH, 3), np.uint8)
    for row, line in enumerate(lines):
        text = _ascii(line[:_LETTERS])
        at = (4, 13 + _LINE * row)
        cv2.putText(words, text, at, cv2.FONT_HERSHEY_SIMPLEX, 0.36, _INK, 1, cv2.LINE_AA)
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), np.vstack([words, strip]))


def write_sheet(folder: Path, sheet: Path) -> int:
    """Put the strips of a folder on one picture and return how many there are; at most 60 are shown."""
    strips = [decoded(path.read_bytes()) for path in sorted(folder.glob("*.png"))]
    if not strips:
        return 0
    tallest = max(strip.shape[0] for strip in strips)
    shown = [_padded(strip, tallest) for strip in strips[:_MOST]]
    shown += [np.zeros_like(shown[0])] * (-len(shown) % _COLUMNS)
    rows = [np.hstack(shown[i : i + _COLUMNS]) for i in range(0, len(shown), _COLUMNS)]
    sheet.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(sheet), np.vstack(rows), [cv2.IMWRITE_JPEG_QUALITY, 85])
    return len(strips)


def _ascii(line: str) -> str:
    """OpenCV's letters know no others."""
    for sign, written in (("±", "+-"), ("°", " deg"), ("²", "2")):
        line = line.replace(sign, written)
    return line.encode("ascii", "replace").decode()


def _padded(strip: Picture, height: int) -> Picture:
    return np.pad(strip, ((0, height - strip.shape[0]), (0, 0), (0, 0)))
