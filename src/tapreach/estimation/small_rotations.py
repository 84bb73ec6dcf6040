"""Many rotations by small angles at once: what the estimator's inner loop needs, and nothing else.

Source: Solà, Deray and Atchuthan, "A micro Lie theory for state estimation in robotics", eq. 132 and 143.
"""

import math

import numpy as np

from tapreach.geometry.finite import FloatArray

_SERIES_UP_TO = 0.25  # squared angle [rad²]; there seven terms are exact to rounding
_POWERS = np.arange(7)
# Columns: sin(t)/t, (1 - cos t)/t², (t - sin t)/t³ as series in t².
_SERIES = np.array([[(-1.0) ** i / math.factorial(2 * i + offset) for offset in (1, 2, 3)] for i in _POWERS])
# v @ _CROSS is the matrix of the cross product with v, row by row.
_CROSS = np.zeros((3, 9))
_CROSS[0, 5], _CROSS[0, 7], _CROSS[1, 2], _CROSS[1, 6], _CROSS[2, 1], _CROSS[2, 3] = -1, 1, 1, -1, -1, 1
_IDENTITY = np.eye(3)


def cross_matrices(vectors: FloatArray) -> FloatArray:
    """Return the matrices (..., 3, 3) of the cross product with vectors (..., 3)."""
    return np.asarray(vectors @ _CROSS).reshape(*vectors.shape, 3)


def backward_rotations(turns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return exp(-turn) and the right Jacobian of exp at turn, (..., 3, 3) each, for turns (..., 3) [rad]."""
    cross = cross_matrices(turns)
    squared = cross @ cross
    factors = _coefficients(np.add.reduce(turns * turns, axis=-1))[..., None, None]
    sine, cosine, third = factors[..., 0, :, :], factors[..., 1, :, :], factors[..., 2, :, :]
    back = _IDENTITY - sine * cross + cosine * squared
    return back, _IDENTITY - cosine * cross + third * squared


def _coefficients(squared_angles: FloatArray) -> FloatArray:
    """Return the factors (..., 3) of the two matrices' terms."""
    if squared_angles.max(initial=0.0) < _SERIES_UP_TO:
        return np.asarray(squared_angles[..., None] ** _POWERS @ _SERIES)
    small = squared_angles < _SERIES_UP_TO
    series = np.where(small, squared_angles, 0.0)[..., None] ** _POWERS @ _SERIES
    angle = np.sqrt(np.where(small, 1.0, squared_angles))
    closed = np.stack(
        [np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3], axis=-1
    )
    return np.where(small[..., None], series, closed)
