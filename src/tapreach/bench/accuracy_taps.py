"""Errors of taps, all with the same standard deviation: independent and normal, correlated, heavy-tailed."""

from collections.abc import Callable

import numpy as np

from tapreach.geometry.finite import FloatArray

CORRELATION = 0.4
"""Between one tap and the next."""
TAIL = 4.0
"""Degrees of freedom of Student's t: one error in 60 beyond 3 sigma, where a normal one has 1 in 370."""

Taps = Callable[[np.random.Generator, int, int], FloatArray]
"""From generator, trials m and views n to errors (m, n, 2), each of variance one."""


def normal(random: np.random.Generator, trials: int, views: int) -> FloatArray:
    """Independent and normal."""
    return random.normal(size=(trials, views, 2))


def heavy_tailed(random: np.random.Generator, trials: int, views: int) -> FloatArray:
    """Independent, Student's t."""
    return np.asarray(random.standard_t(TAIL, size=(trials, views, 2)) * np.sqrt((TAIL - 2.0) / TAIL))


def correlated(random: np.random.Generator, trials: int, views: int) -> FloatArray:
    """Normal, each tap off in part as the one before."""
    return in_sequence(normal(random, trials, views))


def correlated_and_heavy_tailed(random: np.random.Generator, trials: int, views: int) -> FloatArray:
    """Both."""
    return in_sequence(heavy_tailed(random, trials, views))


def in_sequence(errors: FloatArray) -> FloatArray:
    """Return a first-order autoregression with the variance of `errors` (m, n, 2)."""
    sequence = errors.copy()
    fresh = np.sqrt(1.0 - CORRELATION**2)
    for view in range(1, errors.shape[1]):
        sequence[:, view] = CORRELATION * sequence[:, view - 1] + fresh * errors[:, view]
    return sequence
