"""Pictures whose motion is known exactly: a textured plane seen through a warp, with a camera's flaws."""

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.vision.image_io import Gray

SIZE = (480, 640)


@lru_cache(maxsize=12)
def texture(seed: int, finest: float = 2.0, contrast: float = 45.0) -> NDArray[np.float32]:
    """A surface with detail at several sizes, (960, 1280); its middle falls on the picture's middle."""
    rng = np.random.default_rng(seed)
    surface = np.zeros((960, 1280))
    for sigma in (finest, 3 * finest, 8 * finest):
        layer = cv2.GaussianBlur(rng.normal(size=surface.shape), (0, 0), sigma)
        surface += layer / layer.std()
    return np.asarray(surface / surface.std() * contrast + 128.0, dtype=np.float32)


def view(
    surface: NDArray[np.float32],
    shift: tuple[float, float] = (0.0, 0.0),
    scale: float = 1.0,
    angle: float = 0.0,
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """The surface scaled and turned [rad] about the picture's middle, then shifted [px]; and
    picture_from_surface.
    """
    c, s = scale * np.cos(angle), scale * np.sin(angle)
    linear = np.array([[c, -s], [s, c]])
    middle_of_picture, middle_of_surface = np.array([319.5, 239.5]), np.array([639.5, 479.5])
    warp = np.column_stack([linear, middle_of_picture + shift - linear @ middle_of_surface])
    smooth = cv2.GaussianBlur(surface, (0, 0), 0.5 / scale) if scale < 1.0 else surface
    picture = cv2.warpAffine(smooth, warp, (SIZE[1], SIZE[0]), flags=cv2.INTER_CUBIC)
    return np.asarray(picture, dtype=np.float32), warp


def photographed(
    picture: NDArray[np.float32],
    rng: np.random.Generator,
    noise: float = 2.0,
    gain: float = 1.0,
    offset: float = 0.0,
    blur: int = 0,
) -> Gray:
    """What a camera makes of it: brightness, motion blur over `blur` px sideways, noise, JPEG at
    quality 80.
    """
    seen = picture * gain + offset
    if blur > 1:
        seen = cv2.blur(seen, (blur, 1))
    seen = np.clip(seen + rng.normal(0.0, noise, seen.shape), 0, 255).astype(np.uint8)
    _, jpeg = cv2.imencode(".jpg", seen, [cv2.IMWRITE_JPEG_QUALITY, 80])
    return np.asarray(cv2.imdecode(jpeg, cv2.IMREAD_GRAYSCALE), dtype=np.uint8)


def carried(
    point: tuple[float, float], first: NDArray[np.float64], now: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Where the surface point seen at `point` through the first warp is seen through the other, (2,)."""
    on_surface = np.linalg.solve(first[:, :2], np.asarray(point) - first[:, 2])
    return np.asarray(now[:, :2] @ on_surface + now[:, 2])
