"""The simulated camera: exposure, noise, loss, delay, JPEG. Draws with a renderer, knows no clock."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from tapreach.drivers.sim.faults import SimFaults

BLUR_PICTURES = 4
HISTORY = 16


@dataclass(frozen=True, slots=True)
class Snapshot:
    """State of the world (MuJoCo's qpos) at a time."""

    captured_ns: int
    qpos: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SimPicture:
    """A JPEG on its way to the host: when it was truly taken, and when it leaves the camera."""

    captured_ns: int
    leaves_ns: int
    jpeg: bytes


class Draws(Protocol):
    """What the camera needs of a renderer."""

    def render(self, snapshot: NDArray[np.float64], camera: str = "front") -> NDArray[np.uint8]:
        """Return an RGB picture of a state."""
        ...


class SimCamera:
    """Takes pictures of snapshots. The same seed loses the same pictures and makes the same noise."""

    def __init__(self, renderer: Draws, faults: SimFaults, seed: int, delay_ms: float = 0.0) -> None:
        self._renderer = renderer
        self._faults = faults
        self._rng = np.random.default_rng([seed, 2])
        self.unknown_delay_ns = round(faults.camera_delay_ms * 1e6)
        self._delay_ns = round(delay_ms * 1e6) + self.unknown_delay_ns
        self._waiting: deque[SimPicture] = deque()

    def take(self, history: Sequence[Snapshot]) -> None:
        """Expose now; `history` is the last states, oldest first. The picture comes out of `delivered`."""
        if self._rng.random() < self._faults.dropped_frames:
            return
        exposure_ns = round(self._faults.motion_blur_ms * 1e6)
        end_ns = history[-1].captured_ns
        pixels = self._exposed(history, end_ns, exposure_ns)
        captured_ns = end_ns - exposure_ns // 2
        jpeg = encode_jpeg(self._with_noise(pixels), self._faults.jpeg_quality)
        self._waiting.append(SimPicture(captured_ns, end_ns + self._delay_ns, jpeg))

    def delivered(self, now_ns: int) -> list[SimPicture]:
        """Return the pictures that have left the camera by now, oldest first, each once."""
        out = []
        while self._waiting and self._waiting[0].leaves_ns <= now_ns:
            out.append(self._waiting.popleft())
        return out

    def _exposed(self, history: Sequence[Snapshot], end_ns: int, exposure_ns: int) -> NDArray[np.uint8]:
        if exposure_ns == 0:
            return self._renderer.render(history[-1].qpos)
        total: NDArray[np.float32] | None = None
        for share in (np.arange(BLUR_PICTURES) + 0.5) / BLUR_PICTURES:
            state = state_at(history, end_ns - round(exposure_ns * (1.0 - float(share))))
            picture = self._renderer.render(state).astype(np.float32)
            total = picture if total is None else total + picture
        assert total is not None
        return np.asarray(total / BLUR_PICTURES + 0.5, dtype=np.uint8)

    def _with_noise(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        strength = self._faults.exposure_noise
        if strength == 0.0:
            return pixels
        gain = float(np.exp(strength * self._rng.standard_normal()))
        grain = self._rng.standard_normal(pixels.shape, dtype=np.float32) * np.float32(25.5 * strength)
        return np.asarray(np.clip(pixels * np.float32(gain) + grain, 0, 255), dtype=np.uint8)


def state_at(history: Sequence[Snapshot], when_ns: int) -> NDArray[np.float64]:
    """Return the state at a time by linear interpolation; the nearest one outside of the history."""
    later = next((i for i, s in enumerate(history) if s.captured_ns >= when_ns), len(history) - 1)
    if later == 0:
        return history[0].qpos
    a, b = history[later - 1], history[later]
    share = min(1.0, (when_ns - a.captured_ns) / (b.captured_ns - a.captured_ns))
    return np.asarray((1.0 - share) * a.qpos + share * b.qpos)


def encode_jpeg(rgb: NDArray[np.uint8], quality: int) -> bytes:
    """Return the JPEG of an RGB picture (height, width, 3)."""
    bgr = cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR)
    _, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes()


class ShadowPolicy:
    """Gives up shadows before the picture rate; takes them back after a long time with room to spare."""

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._mean_s = 0.0
        self._spare = 0
        self.shadows = True

    def note(self, took_s: float) -> bool:
        """Take the time that the last picture cost and return whether the next one has shadows."""
        # One hiccup counts for two periods at most: it takes a few slow pictures in a row.
        self._mean_s += 0.15 * (min(took_s, 2.0 * self._period_s) - self._mean_s)
        self._spare = self._spare + 1 if self._mean_s < 0.3 * self._period_s else 0
        if self.shadows and self._mean_s > 0.9 * self._period_s:
            self.shadows = False
        elif not self.shadows and self._spare * self._period_s > 10.0:
            self.shadows = True
        return self.shadows
