"""The posterior over the range where the inverse depth is nearly normal: no profile is needed there.

N(rho; estimate, sd²) times the prior, even odds over the logarithm of the range: density 1/rho in rho
(docs/estimation.md, 9). It agrees with `range_posterior` to a tenth of a sigma (tests/estimation).
"""

from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray

UP_TO = 0.25
"""sd(1/Z)·Z up to which it is used."""
_REACH = 4.0
_SIGMAS = np.linspace(-_REACH, _REACH, 161)
_NORMAL = np.exp(-0.5 * _SIGMAS**2)
_OPEN = 1.96  # sigmas, as in `range_posterior`


@dataclass(frozen=True)
class NearNormalPosterior:
    """inverse_depth, sd [1/m], sd at most 0.25 of it; slant: range over Z; nearest, farthest [m]: the prior.

    An answer beyond the prior by more than 4 sigma stands against it, and the prior is dropped.
    """

    inverse_depth: float
    sd: float
    slant: float
    nearest: float
    farthest: float

    @property
    def is_open_far(self) -> bool:
        """True where the farthest range is not worse than the best by more than chance (95 %)."""
        sigmas = (self.inverse_depth - self.slant / self.farthest) / self.sd
        return -_REACH < sigmas < _OPEN

    def quantile(self, probability: float) -> float:
        """Return the range [m] below which the target lies with `probability`."""
        return self.interval(probability, probability)[0]

    def interval(self, low: float, high: float) -> tuple[float, float]:
        """Return the ranges [m] below which the target lies with probability `low` and `high`."""
        inverse_depths = self.inverse_depth + self.sd * _SIGMAS
        weights = self._weights(inverse_depths)
        above = np.cumsum(weights)
        above -= 0.5 * weights
        near, far = np.interp(
            [1.0 - low, 1.0 - high], above / (above[-1] + 0.5 * weights[-1]), inverse_depths
        )
        return self.slant / float(near), self.slant / float(far)

    def _weights(self, inverse_depths: FloatArray) -> FloatArray:
        least, most = self.slant / self.farthest, self.slant / self.nearest
        lowest, highest = float(inverse_depths[0]), float(inverse_depths[-1])
        if not least < highest or not most > lowest:
            return _NORMAL
        densities = _NORMAL / np.maximum(inverse_depths, 0.01 * self.inverse_depth)
        if least <= lowest and highest <= most:
            return np.asarray(densities)
        densities = np.where((inverse_depths >= least) & (inverse_depths <= most), densities, 0.0)
        return np.asarray(densities if densities.any() else _NORMAL)
