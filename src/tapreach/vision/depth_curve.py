"""What pictures cost at every supposed depth, all together, and whether one depth stands out."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tapreach.geometry.finite import FloatArray

CLEAR = 12.0
"""A depth stands out when every other costs so much more [squared sigmas]."""
_APART = 3
"""Two valleys that are so many steps apart at most are one."""
_TWO_SIGMA = 8.0
"""Depths that cost no more than this above the best are within two sigma of it; twice what independent
samples would make it.
"""


@dataclass(frozen=True, eq=False)
class DepthCurve:
    """inverse_depths: (m,) [1/m], evenly spaced. costs: (m,) [squared sigmas]."""

    inverse_depths: FloatArray
    costs: FloatArray

    @classmethod
    def of(cls, inverse_depths: FloatArray, costs: Sequence[FloatArray], most: float) -> "DepthCurve":
        """Return the sum of what each picture costs (m,).

        NaN, where the place is not on a picture, counts as what chance would cost there: the median of the
        picture, or `most` where it is never on it.
        """
        return cls(inverse_depths, np.sum([_filled(each, most) for each in costs], axis=0))

    @property
    def best(self) -> int:
        """The number of the cheapest depth."""
        return int(np.argmin(self.costs))

    @property
    def inverse_depth(self) -> float:
        """The cheapest inverse depth [1/m], between the steps by a parabola."""
        best, step = self.best, float(self.inverse_depths[1] - self.inverse_depths[0])
        if not 0 < best < len(self.costs) - 1:
            return float(self.inverse_depths[best])
        before, here, after = self.costs[best - 1 : best + 2]
        bend = before - 2.0 * here + after
        shift = 0.5 * (before - after) / bend if bend > 0.0 else 0.0
        return float(self.inverse_depths[best] + shift * step)

    @property
    def sigma(self) -> float:
        """One sigma of it [1/m], by the width of the valley; a quarter of a step at least."""
        is_inside = self.costs <= self.costs[self.best] + _TWO_SIGMA
        (outside,) = np.nonzero(~is_inside)
        left = max((int(each) for each in outside if each < self.best), default=-1)
        right = min((int(each) for each in outside if each > self.best), default=len(self.costs))
        return (right - left - 1) / 4.0 * float(self.inverse_depths[1] - self.inverse_depths[0])

    @property
    def margin(self) -> float:
        """How much more the cheapest other valley costs [squared sigmas]; infinite without one."""
        padded = np.concatenate([[np.inf], self.costs, [np.inf]])
        is_valley = (self.costs <= padded[:-2]) & (self.costs <= padded[2:])
        is_valley &= np.abs(np.arange(len(self.costs)) - self.best) > _APART
        return float(self.costs[is_valley].min() - self.costs[self.best]) if is_valley.any() else np.inf

    @property
    def is_clear(self) -> bool:
        """True where one depth stands out, and it is not at an end."""
        return self.margin >= CLEAR and 0 < self.best < len(self.costs) - 1


def _filled(cost: FloatArray, most: float) -> FloatArray:
    seen = cost[np.isfinite(cost)]
    return np.where(np.isfinite(cost), cost, float(np.median(seen)) if seen.size else most)
