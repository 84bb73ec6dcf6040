"""Noise and saving, shared by everything that draws a texture."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

Pixels = NDArray[np.float64]


def noise(height: int, width: int, seed: int, cells: int = 4, octaves: int = 6, decay: float = 0.6) -> Pixels:
    """Return tileable fractal noise of mean about 0 and range about ±1, shape (height, width)."""
    rng = np.random.default_rng(seed)
    total = np.zeros((height, width))
    amplitude, weight = 1.0, 0.0
    for octave in range(octaves):
        across = cells * 2**octave
        if across > min(height, width):
            break
        grid = rng.random((across, across)).astype(np.float32)
        total += amplitude * _stretch_periodic(grid, height, width)
        weight += amplitude
        amplitude *= decay
    return 4.0 * (total / weight - 0.5)


def streaks(height: int, width: int, seed: int, length: int = 96) -> Pixels:
    """Return noise drawn out along the rows, as the grain of wood, tileable, shape (height, width)."""
    rng = np.random.default_rng(seed)
    raw = rng.standard_normal((height, width))
    spectrum = np.fft.rfft(raw, axis=1) * np.exp(-((np.arange(width // 2 + 1) * length / width) ** 2))
    drawn = np.fft.irfft(spectrum, n=width, axis=1)
    return np.asarray(drawn / drawn.std())


def flat(height: int, width: int, colour: tuple[int, int, int]) -> Pixels:
    """Return a picture of one colour, shape (height, width, 3)."""
    return np.ones((height, width, 3)) * np.asarray(colour, dtype=float)


def save_texture(path: Path, pixels: Pixels, colours: int) -> None:
    """Write a PNG of at most `colours` colours, which keeps noisy textures small."""
    picture = Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8))
    palette = picture.quantize(colours, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    palette.save(path, optimize=True)


def _stretch_periodic(grid: NDArray[np.float32], height: int, width: int) -> Pixels:
    rows = _smooth_weights(height, grid.shape[0])
    columns = _smooth_weights(width, grid.shape[1])
    return np.asarray(rows @ grid @ columns.T, dtype=float)


def _smooth_weights(count: int, cells: int) -> Pixels:
    place = np.arange(count) * cells / count
    low = np.floor(place).astype(int)
    share = place - low
    share = share * share * (3 - 2 * share)
    weights = np.zeros((count, cells))
    weights[np.arange(count), low % cells] += 1 - share
    weights[np.arange(count), (low + 1) % cells] += share
    return weights
