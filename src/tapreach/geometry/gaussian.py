"""Regions of a normal distribution: from a covariance to what can be drawn or tested."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import gammaincinv

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite_array


@dataclass(frozen=True)
class Ellipse:
    """A confidence region: half axes (n,) longest first, and their unit directions as columns (n, n)."""

    half_axes: FloatArray
    directions: FloatArray

    @property
    def angle(self) -> float:
        """Direction of the longest axis in its first two coordinates [rad], -pi/2 to pi/2."""
        x, y = self.directions[0, 0], self.directions[1, 0]
        return math.atan2(y, x) if x >= 0.0 else math.atan2(-y, -x)


def require_covariance(name: str, covariance: npt.ArrayLike, size: int) -> FloatArray:
    """Return a covariance (size, size), made exactly symmetric. Raises InputError where it cannot be one."""
    given = finite_array(name, covariance, (size, size))
    scale = float(np.abs(given).max(initial=0.0))
    if float(np.abs(given - given.T).max(initial=0.0)) > 1e-6 * scale:
        raise InputError(f"{name} is not symmetric; a covariance must be")
    symmetric = (given + given.T) / 2.0
    smallest = float(np.linalg.eigvalsh(symmetric)[0]) if size else 0.0
    if smallest < -1e-9 * scale:
        raise InputError(f"{name} has the eigenvalue {smallest:.3g}; a covariance has none below 0")
    return np.asarray(symmetric)


def chi2_limit(probability: float, dimensions: int) -> float:
    """Return the squared Mahalanobis distance that holds `probability` of a normal distribution."""
    # scipy.stats.chi2.ppf, without the second that importing scipy.stats takes.
    return 2.0 * float(gammaincinv(dimensions / 2.0, probability))


def confidence_ellipse(covariance: npt.ArrayLike, probability: float = 0.95) -> Ellipse:
    """Return the region around the mean that holds `probability`, for a covariance (n, n)."""
    given = np.asarray(covariance, dtype=np.float64)
    symmetric = require_covariance("covariance", given, len(given))
    values, directions = np.linalg.eigh(symmetric)
    half_axes = np.sqrt(np.clip(values, 0.0, None) * chi2_limit(probability, len(values)))
    return Ellipse(half_axes[::-1].copy(), directions[:, ::-1].copy())


def squared_mahalanobis(error: npt.ArrayLike, covariance: npt.ArrayLike) -> float:
    """Return errorᵀ covariance⁻¹ error; the covariance must be invertible."""
    given = np.asarray(error, dtype=np.float64)
    return float(given @ np.linalg.solve(np.asarray(covariance, dtype=np.float64), given))
