"""The posterior over the range where the inverse depth is nearly normal: no profile is needed there.

N(rho; estimate, sd²) times the prior, whose density in rho goes as rho^(falloff - 1)
(docs/estimation.md, 9a). It agrees with `range_posterior` to a tenth of a sigma (tests/estimation).
"""

from dataclasses import dataclass

import numpy as np

from tapreach.estimation.range_posterior import RangePrior
from tapreach.geometry.finite import FloatArray

UP_TO = 0.25
"""sd(1/Z)·Z up to which it is used."""
_REACH = 4.0
_SIGMAS = np.linspace(-_REACH, _REACH, 161)
_NORMAL = np.exp(-0.5 * _SIGMAS**2)
_OPEN = 1.96  # sigmas, as in `range_posterior`


@dataclass(frozen=True)
class NearNormalPosterior:
    """inverse_depth, sd [1/m], sd at most 0.25 of it; slant: range over Z; prior: over the range.

    An answer beyond the prior by more than 4 sigma stands against it, and the prior is dropped.
    """

    inverse_depth: float
    sd: float
    slant: float
    prior: RangePrior

    @property
    def is_open_far(self) -> bool:
        """True where the farthest range is not worse than the best by more than chance (95 %)."""
        sigmas = (self.inverse_depth - self.slant / self.prior.farthest) / self.sd
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
        least, most = self.slant / self.prior.farthest, self.slant / self.prior.nearest
        lowest, highest = float(inverse_depths[0]), float(inverse_depths[-1])
        if not least < highest or not most > lowest:
            return _NORMAL
        densities = _NORMAL
        if self.prior.falloff != 1.0:
            relative = np.maximum(inverse_depths / self.inverse_depth, 0.01)
            densities = _NORMAL * relative ** (self.prior.falloff - 1.0)
        if least <= lowest and highest <= most:
            return np.asarray(densities)
        densities = np.where((inverse_depths >= least) & (inverse_depths <= most), densities, 0.0)
        return np.asarray(densities if densities.any() else _NORMAL)
