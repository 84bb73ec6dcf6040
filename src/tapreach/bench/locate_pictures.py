"""Pictures of the taps that went wrong: a strip for each, and a sheet of all."""

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.bench.locate_outcome import Outcome
from tapreach.geometry.finite import FloatArray

Picture = NDArray[np.uint8]

_TRUE, _FOLLOWED, _INK = (60, 60, 255), (80, 255, 80), (255, 255, 255)
_COLUMNS, _MOST = 3, 60
_WIDTH = 560


def write_glimpse(
    folder: Path,
    outcome: Outcome,
    first: tuple[bytes, FloatArray],
    last: tuple[bytes, FloatArray],
    followed: FloatArray | None,
) -> None:
    """Write the tapped frame beside the last one, each JPEG with the true place (2,) [px] ringed in red; in
    green where it was last followed to.
    """
    pictures = [_decoded(jpeg) for jpeg, _ in (first, last)]
    for picture, (_, pixel) in zip(pictures, (first, last), strict=True):
        _ring(picture, pixel, _TRUE)
    if followed is not None:
        _ring(pictures[1], followed, _FOLLOWED)
    both = np.hstack(pictures)
    height = _WIDTH * both.shape[0] // both.shape[1]
    strip = cv2.resize(both, (_WIDTH, height), interpolation=cv2.INTER_AREA)
    words = np.zeros((34, _WIDTH, 3), np.uint8)
    error = "refused" if outcome.range_error is None else f"{100.0 * outcome.range_error:+.1f} %"
    lines = (
        f"{outcome.tap} {outcome.scene}: {outcome.thing}, {outcome.distance:.2f} m, {outcome.arm}: {error}",
        outcome.note[:95],
    )
    for row, line in enumerate(lines):
        text = line.encode("ascii", "replace").decode()
        cv2.putText(words, text, (4, 13 + 15 * row), cv2.FONT_HERSHEY_SIMPLEX, 0.36, _INK, 1, cv2.LINE_AA)
    folder.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(
        str(folder / f"{outcome.tap:04d}_{outcome.arm.replace(' ', '_')}.png"), np.vstack([words, strip])
    )


def _decoded(jpeg: bytes) -> Picture:
    return np.asarray(cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR), np.uint8)


def _ring(picture: Picture, pixel: FloatArray, colour: tuple[int, int, int]) -> None:
    if np.all(np.abs(pixel) < 1e4):
        cv2.circle(picture, (round(float(pixel[0])), round(float(pixel[1]))), 9, colour, 2, cv2.LINE_AA)


def write_sheet(folder: Path, sheet: Path) -> int:
    """Put the strips of a folder on one picture and return how many there are; at most 60 are shown."""
    strips = [_decoded(path.read_bytes()) for path in sorted(folder.glob("*.png"))]
    if not strips:
        return 0
    shown = strips[:_MOST]
    shown += [np.zeros_like(shown[0])] * (-len(shown) % _COLUMNS)
    rows = [np.hstack(shown[i : i + _COLUMNS]) for i in range(0, len(shown), _COLUMNS)]
    sheet.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(sheet), np.vstack(rows), [cv2.IMWRITE_JPEG_QUALITY, 85])
    return len(strips)
