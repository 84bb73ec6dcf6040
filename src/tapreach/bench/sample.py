"""Medians, percentiles and slopes of measured series."""

from collections.abc import Sequence

import numpy as np

from tapreach.errors import InputError


def median(values: Sequence[float]) -> float:
    """Return the median. Raises InputError for no values."""
    return percentile(values, 50)


def percentile(values: Sequence[float], percent: float) -> float:
    """Return the percentile by linear interpolation. Raises InputError for no values."""
    if not values:
        raise InputError(f"nothing was measured: no values for a percentile ({percent:g} %)")
    return float(np.percentile(np.asarray(values), percent))


def slope(times: Sequence[float], values: Sequence[float]) -> float:
    """Return the least-squares slope of `values` over `times`. Raises InputError for fewer than two times."""
    if len(set(times)) < 2:
        raise InputError(f"a slope needs two different times; got {len(set(times))}")
    centred = np.asarray(times) - np.mean(times)
    return float(centred @ np.asarray(values) / (centred @ centred))
