"""Many rotations by small angles at once: what the estimator's inner loop needs, and nothing else.

Source: Solà, Deray and Atchuthan, "A micro Lie theory for state estimation in robotics", eq. 132 and 143.
"""

import math

import numpy as np

from tapreach.geometry.finite import FloatArray

_SERIES_UP_TO = 0.25  # squared angle [rad²]; there seven terms are exact to rounding
_POWERS = np.arange(7)
# Columns: sin(t)/t, (1 - cos t)/t², (t - sin t)/t³ as series in t².
_TERMS = np.array([[(-1.0) ** i / math.factorial(2 * i + offset) for offset in (1, 2, 3)] for i in _POWERS])
# How much of identity, cross product and its square is in each of the two matrices, from those three.
_ONES = np.array([1.0, 0.0, 0.0, 1.0, 0.0, 0.0])
_SHARES = np.array([[0.0, -1, 0, 0, 0, 0], [0, 0, 1, 0, -1, 0], [0, 0, 0, 0, 0, 1]])
_SERIES = _TERMS @ _SHARES + np.outer(_POWERS == 0, _ONES)
# v @ _CROSS is the matrix of the cross product with v, row by row.
_CROSS = np.zeros((3, 9))
_CROSS[0, 5], _CROSS[0, 7], _CROSS[1, 2], _CROSS[1, 6], _CROSS[2, 1], _CROSS[2, 3] = -1, 1, 1, -1, -1, 1
_IDENTITY = np.eye(3)


def cross_matrices(vectors: FloatArray) -> FloatArray:
    """Return the matrices (..., 3, 3) of the cross product with vectors (..., 3)."""
    return np.asarray(vectors @ _CROSS).reshape(*vectors.shape, 3)


def backward_rotations(turns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return exp(-turn) and the right Jacobian of exp at turn, (..., 3, 3) each, for turns (..., 3) [rad]."""
    stack = turns.shape[:-1]
    rows = np.empty((*stack, 3, 9))
    rows[..., 0, :] = _IDENTITY.ravel()
    np.matmul(turns, _CROSS, out=rows[..., 1, :])
    cross, squared = rows[..., 1, :].reshape(*stack, 3, 3), rows[..., 2, :].reshape(*stack, 3, 3)
    np.matmul(cross, cross, out=squared)
    shares = _shares((turns * turns).sum(axis=-1)).reshape(*stack, 2, 3)
    both = (shares @ rows).reshape(*stack, 2, 3, 3)
    return both[..., 0, :, :], both[..., 1, :, :]


def _shares(squared_angles: FloatArray) -> FloatArray:
    """Return the factors (..., 6) of the two matrices' three parts."""
    if squared_angles.max(initial=0.0) < _SERIES_UP_TO:
        return np.asarray(squared_angles[..., None] ** _POWERS @ _SERIES)
    small = squared_angles < _SERIES_UP_TO
    series = np.where(small, squared_angles, 0.0)[..., None] ** _POWERS @ _TERMS
    angle = np.sqrt(np.where(small, 1.0, squared_angles))
    closed = np.stack(
        [np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2, (angle - np.sin(angle)) / angle**3], axis=-1
    )
    return np.asarray(np.where(small[..., None], series, closed) @ _SHARES + _ONES)
