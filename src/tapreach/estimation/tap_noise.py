"""How the errors of several taps hang together (docs/estimation.md, 4)."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite, not_negative


@dataclass(frozen=True)
class TapNoise:
    """What the pixel sigmas alone do not say. Without it taps err independently of each other.

    correlation: of each tap's error with that of the tap before, -1 < correlation < 1; k taps apart it is
    correlation^k (a first-order autoregression). Real taps of one person: 0.4. It must be told, as a few
    views cannot show it. shared_bias_px: one sigma [px], in u and in v, of an error common to all taps.
    Raises InputError for values that are not such.
    """

    correlation: float = 0.0
    shared_bias_px: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "correlation", finite("correlation", self.correlation))
        if not -1.0 < self.correlation < 1.0:
            raise InputError(f"correlation is {self.correlation}; it must lie between -1 and 1, without them")
        object.__setattr__(self, "shared_bias_px", not_negative("shared_bias_px", self.shared_bias_px))


def whitening(correlation: float, is_used: npt.NDArray[np.bool_]) -> FloatArray:
    """Return W (n, n) that makes the errors of the views used, in sigmas, independent: equation (5a).

    Autoregressions are Markov: each error less its expectation given the last one used before it, over what
    is then left of its spread. This is the inverse of the Cholesky factor of their correlation. Views left
    out have the row and the column of the identity.
    """
    whitener = np.eye(len(is_used))
    used = np.flatnonzero(is_used)
    before, after = used[:-1], used[1:]
    shared = correlation ** (after - before)
    whitener[after, after] = 1.0 / np.sqrt(1.0 - shared * shared)
    whitener[after, before] = -shared * whitener[after, after]
    return whitener
