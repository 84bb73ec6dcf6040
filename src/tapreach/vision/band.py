"""Where in the next picture a place can be at all: a band around the caller's guesses.

One guess for each supposed distance lies along the epipolar line, so that a look-alike beside it is refused.
Source: Hartley and Zisserman, Multiple View Geometry, chapter 9.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.vision.track import Guess

_GATE = 3.0
"""Standard deviations that a place may lie off the guesses."""
_ALONG = 0.35
"""One standard deviation along the line, as a share of its length."""
_MOST_SCALE_RATIO = 1.5
_STALE = 0.4
"""The band grows by so much for each picture in which the place was not seen [px]."""


@dataclass(frozen=True, eq=False)
class Band:
    """guesses: (n, 2) [px] in the order along the line; scales: (n,). likeliest: (2,) the first guess.
    half_width [px], may be infinite.
    """

    guesses: FloatArray
    scales: FloatArray
    likeliest: FloatArray
    half_width: float

    @classmethod
    def around(cls, guesses: Sequence[Guess], lost_for: int = 0) -> "Band":
        """Return the band of at least one guess, `lost_for` pictures after the place was last seen."""
        places = np.array([(guess.u, guess.v) for guess in guesses])
        spread = places - places.mean(axis=0)
        along = np.linalg.eigh(spread.T @ spread)[1][:, -1]
        order = np.argsort(spread @ along)
        scales = np.array([guess.scale for guess in guesses])
        width = _GATE * max(guess.sigma for guess in guesses) + _STALE * min(lost_for, 40)
        return cls(places[order], scales[order], places[0], width)

    def holds(self, u: float, v: float, scale: float | None = None) -> bool:
        """Tell whether the place can be at (u, v), and there be seen at `scale` against the tapped frame."""
        if math.isinf(self.half_width):
            return True
        distances = self._to_segments(np.array([u, v]))
        nearest = int(np.argmin(distances))
        if distances[nearest] > self.half_width:
            return False
        if scale is None:
            return True
        after = min(nearest + 1, len(self.scales) - 1)
        near = self.scales[[nearest, after]]
        low, high = float(near.min()), float(near.max())
        return low / _MOST_SCALE_RATIO < scale < high * _MOST_SCALE_RATIO

    @property
    def length(self) -> float:
        """From end to end [px]."""
        return float(np.linalg.norm(self.guesses[-1] - self.guesses[0])) + 2.0 * self.half_width

    def reach_from(self, u: float, v: float) -> float:
        """Return how far from (u, v) the place could be instead [px]."""
        return float(np.linalg.norm(self.guesses - (u, v), axis=1).max()) + self.half_width

    def is_inside(self, size: ImageSize) -> bool:
        """Tell whether every guess lies on a picture of `size`: then what is not found is not there."""
        return all(Pixel(float(u), float(v)).is_inside(size) for u, v in self.guesses)

    def expected(self) -> tuple[FloatArray, FloatArray] | None:
        """Return the likeliest place (2,) and its covariance (2, 2) [px²]; None where nothing is known."""
        if math.isinf(self.half_width):
            return None
        way = self.guesses[-1] - self.guesses[0]
        across = (self.half_width / _GATE) ** 2 * np.eye(2)
        return self.likeliest, across + np.outer(way, way) * _ALONG**2

    def _to_segments(self, place: FloatArray) -> FloatArray:
        """Return the distance (m,) [px] from each piece of the line."""
        if len(self.guesses) == 1:
            return np.asarray(np.linalg.norm(self.guesses - place, axis=1))
        starts, ways = self.guesses[:-1], np.diff(self.guesses, axis=0)
        squared = np.maximum((ways**2).sum(axis=1), 1e-9)
        shares = np.clip(((place - starts) * ways).sum(axis=1) / squared, 0.0, 1.0)
        return np.asarray(np.linalg.norm(starts + shares[:, None] * ways - place, axis=1))
